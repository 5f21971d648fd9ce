"""`python -m experiments.settings` prints the JSON schema of the configuration, for editors that check YAML."""

import json
import sys

from experiments.settings.settings import Settings

sys.stdout.write(json.dumps(Settings.model_json_schema(), indent=1) + "\n")
