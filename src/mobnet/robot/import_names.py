"""Names of bodies, joints and limbs as a table takes them: plain words, each once."""

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import Any

LONGEST = 50  # letters of a name
NUMBER = 4  # of these, for a number that tells it from others
MOST_NAME = 20  # letters of the name of a limb
PARTS = {"leg": {"hip", "knee", "ankle"}, "arm": {"shoulder", "elbow", "wrist"}}  # words of joints that tell a limb


def words_of(names: Sequence[str], kind: str, taken: Collection[str] = ()) -> list[str]:
    """Return a word for each name, each once and none that is taken; names that are such words keep them.

    A name without a letter of ASCII becomes the kind with its number, such as `body_3`.
    """
    words = [_word(name, f"{kind}_{k}") for k, name in enumerate(names)]
    used = set(taken)
    chosen = list[str]()
    kept = {name for name, word in zip(names, words, strict=True) if name == word and name not in used}
    for name, word in zip(names, words, strict=True):
        if name in kept:
            kept.remove(name)  # the first of two equal ones has it
            own = name
        else:
            own = _free(word, used | kept)
        used.add(own)
        chosen.append(own)
    return chosen


def _word(name: str, otherwise: str) -> str:
    word = re.sub(r"\W", "_", name, flags=re.ASCII).strip("_") or otherwise
    return (word if word[0].isalpha() else f"b_{word}")[:LONGEST]


def _free(word: str, used: Collection[str]) -> str:
    """Return a word, with a number if it is used."""
    word_tried = word
    number = 2
    while word_tried in used:
        word_tried = f"{word[: LONGEST - NUMBER]}_{number}"
        number = number + 1
    return word_tried


def renamed(names: Iterable[str], words: Iterable[str], kind: str) -> Iterator[str]:
    """Yield which names a table has in other words than their own letters give."""
    changed = [
        f"{word} is {f'{name!r}' if name else 'without a name'}"
        for name, word in zip(names, words, strict=True)
        if word != re.sub(r"\W", "_", name, flags=re.ASCII)
    ]
    if changed:
        yield f"names of {kind}: in the file {', '.join(changed)}"


def title_of(name: str, otherwise: str) -> str:
    """Return the name of a robot."""
    for text in (name, otherwise):
        word = re.sub(r"[^A-Za-z0-9 _.-]", "-", text).strip(" _.-")
        if word:
            return word
    return "robot"


def limbs(bodies: Sequence[Mapping[str, Any]], joints: Sequence[Mapping[str, Any]]) -> dict[str, list[str]]:
    """Return limb -> its joints: chains without a branch, named by what the names of their joints have in common."""
    moved = {joint["body"]: joint["id"] for joint in joints}
    parents = {body["name"]: body["parent"] for body in bodies}
    children: dict[str, list[str]] = {}
    for body in bodies:
        if body["name"] in moved:
            carrier = body["parent"]
            while carrier in parents and carrier not in moved:
                carrier = parents[carrier]
            children.setdefault(carrier, []).append(body["name"])
    chains: dict[str, list[str]] = {}
    roots = list[str]()
    for carrier, carried in children.items():
        roots += carried if carrier not in moved else []
    waiting = roots[::-1]
    while waiting:
        body = waiting.pop()
        chain = [moved[body]]
        while len(children.get(body, ())) == 1:
            (body,) = children[body]
            chain.append(moved[body])
        chains[_limb_name(chain, [*chains, *moved.values()])] = chain
        waiting += children.get(body, [])[::-1]
    return chains


def _limb_name(chain: Sequence[str], taken: Iterable[str]) -> str:
    """Return a name for a chain that no other limb and no joint has."""
    parts = [re.findall(r"[A-Za-z0-9]+", joint) for joint in chain]
    common = set(parts[0]).intersection(*parts)
    shared = [word for word in parts[0] if word in common and word.lower() != "joint"]
    words = set[str]()
    for piece in parts:
        words.update(word.lower() for word in piece)
    shared += [part for part, marks in PARTS.items() if shared and marks & words and part not in shared]
    stem = "".join(shared)[: MOST_NAME - 2] if shared and shared[0][0].isalpha() else "limb"
    lowered = {name.casefold() for name in taken}
    name = stem
    number = 2
    while name.casefold() in lowered:
        name = f"{stem[: MOST_NAME - len(str(number))]}{number}"
        number = number + 1
    return name
