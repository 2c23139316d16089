"""Code without physics that every folder uses: parameters, arrays, files, processes, text."""
