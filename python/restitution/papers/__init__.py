"""Papers, redrawn and judged claim by claim; one folder a paper."""
