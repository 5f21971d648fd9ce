"""From estimates to the paper's tables, figures and claims, in floors: number, measure, figures and tables, report."""
