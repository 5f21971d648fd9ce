"""What TeX's log says of a paper that was set, but not as a reader should see it."""

import re

OVERFULL_PT = 5.0  # less is hardly seen beside a column of text
INPUT = re.compile(r"\(\./([\w./-]+\.tex)")
NAMES = re.compile(  # labels that stand twice, and labels and works that do not exist
    r"Label `[^']*' multiply defined|(?:Reference|Citation) `[^']*'(?: on page \d+)? undefined"
)
LARGE = re.compile(
    r"Overfull \\[hv]box \((?P<box>[\d.]+)pt too (?:wide|high)\)[\w -]*"
    r"|Float too large for page by (?P<float>[\d.]+)pt on input line \d+"
)


def page_faults(log: str) -> list[str]:
    """Return what runs off its page or column by more than OVERFULL_PT [pt], and labels and works that are not there.

    A label that stands twice is a fault, too.

    What is too large is followed by the file of TeX that was read last: the table at fault, unless it is in prose.
    `log` is that of one run, with lines that TeX did not break.
    """
    faults = []
    last = "main file"
    for line in log.splitlines():
        last = next(reversed(INPUT.findall(line)), last)
        if large := LARGE.search(line):
            if float(large["box"] or large["float"]) > OVERFULL_PT:
                faults.append(f"{large[0].strip()} (after {last})")
        elif name := NAMES.search(line):
            faults.append(name[0])
    return list(dict.fromkeys(faults))
