"""What TeX's log says of a paper that was set, but not as a reader should see it."""

import re

OVERFULL_PT = 5.0  # less is hardly seen beside a column of text
INPUT = re.compile(r"\(\./([\w./-]+\.tex)")
FAULTS = (  # what is said of a fault, and its size [pt] where it has one
    re.compile(r"Overfull \\[hv]box \((?P<size>[\d.]+)pt too (?:wide|high)\)[\w -]*"),
    re.compile(r"Float too large for page by (?P<size>[\d.]+)pt on input line \d+"),
    re.compile(r"Label `[^']*' multiply defined"),
)


def page_faults(log: str) -> list[str]:
    """Return what runs off its page or column by more than OVERFULL_PT [pt], and the labels that are defined twice.

    Each text ends with the file of TeX that was read last, which is the table at fault unless the fault is in prose.
    `log` is that of one run, with lines that TeX did not break.
    """
    faults, last = [], "main file"
    for line in log.splitlines():
        last = next(reversed(INPUT.findall(line)), last)
        found = next((match for match in (fault.search(line) for fault in FAULTS) if match), None)
        size = found and found.groupdict().get("size")
        if found and (size is None or float(size) > OVERFULL_PT):
            faults.append(f"{found[0].strip()} (after {last})")
    return list(dict.fromkeys(faults))
