"""Papers, redrawn and judged claim by claim: one machinery, and a folder with what is each paper's own."""
