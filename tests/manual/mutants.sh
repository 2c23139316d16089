# Mutation: the sources are changed one place at a time, to see which changes no test notices; tests/manual/mutants.md explains those that
# live. The first argument is the part of the core's changes to try, as 0/256, the others are words of the paths of its files.
# A tool that is not here says so.
shard=${1:-0/256}
[ $# -gt 0 ] && shift
if command -v cargo-mutants >/dev/null 2>&1 && .venv/bin/python -c "import tree_sitter_rust" 2>/dev/null; then
    .venv/bin/python tests/manual/mutants.py --shard "$shard" "$@"
else
    echo "core: did not run; it takes cargo-mutants (cargo install --locked cargo-mutants), and tree-sitter and tree-sitter-rust (pip)"
fi
if .venv/bin/python -c "import mutmut.mutation.file_mutation" 2>/dev/null; then
    .venv/bin/python tests/manual/mutants_package.py "$@"
else
    echo "package: did not run; it takes mutmut (pip)"
fi
