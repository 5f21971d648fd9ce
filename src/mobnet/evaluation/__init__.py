"""From estimates to the paper's tables, figures and claims: errors, intervals, layout."""
