"""What every folder needs and no physics: parameters, arrays, files, processes, text."""
