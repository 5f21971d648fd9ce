"""The words of verdicts on claims: how a claim is judged, by what it is counted, and what stands in for a network."""

# `outcome` of a count: a verdict, on both or on one of size and sign, all of them, or one of the next line, of what
# fails and of what the paper prints a number of
UNEXPLAINED = "without a cause"
BEYOND = "beyond reach"
PRINTED = "printed"
HELD = "in our interval"
NEAR = "within a factor of 1.5"
# Methods that know nothing of what they are judged on, each in the place of the network of a claim, and the columns of
# the table of claims with the verdicts that they would have: the last one is MOB-Net's own estimate, half a walk late.
MOB_NET = "MOB-Net"
SHUFFLED = f"{MOB_NET}-shuffled"
STAND_INS = {"zero": "with_zero", "MOB": "with_mob", SHUFFLED: "with_shuffled"}
# Outcomes of them: statements that a method could be judged on, and those that would be reproduced
JUDGED_WITH, REPRODUCED_WITH = "judged with {}", "reproduced with {}"
# Verdicts on the size and on the sign of a claim; both together, in the order in which they are shown: what counts
# against us first. A description would be reproduced, but its number tells too little to be counted as that, or it is
# never judged.
OPEN = "open"
INSIDE, OUTSIDE = "inside", "outside"
SIZE_VERDICTS = (INSIDE, OUTSIDE, OPEN)
SAME, OPPOSITE = "same", "opposite"
SIGN_VERDICTS = (SAME, OPPOSITE, OPEN)
NOT_REPRODUCED = "not reproduced"
SIGN_ONLY = "sign only"
DESCRIPTION = "description"
SIGN_AT_LEAST = "sign at least"
REPRODUCED = "reproduced"
NOT_MEASURED = "not measured"
VERDICTS = (NOT_REPRODUCED, SIGN_ONLY, OPEN, DESCRIPTION, SIGN_AT_LEAST, REPRODUCED, NOT_MEASURED)
# Values of `score` of a claim; PAPER is that of all claims of the paper together
OBSERVER, NETWORKS, NO_NUMBER, OURS = SCORED = ("observer", "networks", "no number", "ours")
PAPER = "paper"
NOT_PRINTED = "not in the paper"  # where a claim of our own is printed
