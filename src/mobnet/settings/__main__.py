"""`python -m mobnet.settings`: print the JSON schema of the configuration, for editors that complete and check YAML."""

import json
import sys

from mobnet.settings.settings import Settings

sys.stdout.write(json.dumps(Settings.model_json_schema(), indent=1) + "\n")
