"""What archives and indexes read of this software, made from CITATION.cff: codemeta.json and .zenodo.json.

`python -m experiments.site archives` writes both; a test fails when one is out of date.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

from mobnet.core.files import read_text, write_json

CITATION = Path("CITATION.cff")
CODEMETA = Path("codemeta.json")
ZENODO = Path(".zenodo.json")
CONTEXT = "https://w3id.org/codemeta/3.0"
LICENCES = "https://spdx.org/licenses"
RUNS_ON = "Linux"
LANGUAGE = "Python"
DERIVED = "isDerivedFrom"  # relation of this software to the article, in the words of Zenodo


def renew() -> None:
    """Write both files of the repository."""
    citation = yaml.safe_load(read_text(CITATION))
    write_json(CODEMETA, codemeta(citation))
    write_json(ZENODO, zenodo(citation))


def codemeta(citation: Mapping[str, Any]) -> dict[str, Any]:
    """Return CITATION.cff in the words of CodeMeta 3.0, which Software Heritage and other indexes read."""
    articles: list[dict[str, Any]] = []
    for reference in citation["references"]:
        article = {
            "@type": "ScholarlyArticle",
            "@id": f"https://doi.org/{reference['doi']}",
            "name": reference["title"],
            "author": [_person(author) for author in reference["authors"]],
            "isPartOf": {"@type": "Periodical", "name": reference["journal"]},
            "datePublished": str(reference["date-published"]),
        }
        articles.append(article)
    return {
        "@context": CONTEXT,
        "@type": "SoftwareSourceCode",
        "name": citation["title"],
        "description": citation["abstract"].strip(),
        "version": citation["version"],
        "dateModified": str(citation["date-released"]),
        "license": f"{LICENCES}/{citation['license']}",
        "author": [{"@type": "Organization", "name": author["name"]} for author in citation["authors"]],
        "keywords": list(citation["keywords"]),
        "programmingLanguage": LANGUAGE,
        "operatingSystem": RUNS_ON,
        "citation": articles,
    }


def zenodo(citation: Mapping[str, Any]) -> dict[str, Any]:
    """Return CITATION.cff in the words of a deposit in Zenodo."""
    related: list[dict[str, str]] = []
    for reference in citation["references"]:
        related.append({"identifier": reference["doi"], "scheme": "doi", "relation": DERIVED})
    return {
        "title": citation["title"],
        "description": citation["abstract"].strip(),
        "upload_type": "software",
        "version": citation["version"],
        "publication_date": str(citation["date-released"]),
        "license": citation["license"],
        "creators": [{"name": author["name"]} for author in citation["authors"]],
        "keywords": list(citation["keywords"]),
        "related_identifiers": related,
        "notes": citation["message"].strip(),
    }


def _person(author: Mapping[str, str]) -> dict[str, str]:
    """Return an author of an article in the words of CodeMeta."""
    return {"@type": "Person", "givenName": author["given-names"], "familyName": author["family-names"]}
