# Mutation: the sources are changed one place at a time, to see which changes no test notices; tests/mutants.md explains those that
# live. The first argument is the part of the core's changes to try, as 0/256, the others are words of the paths of its files.
# A tool that is not here says so.
shard=${1:-0/256}
[ $# -gt 0 ] && shift
if command -v cargo-mutants >/dev/null 2>&1 && .venv/bin/python -c "import tree_sitter_rust" 2>/dev/null; then
    .venv/bin/python tests/mutants.py --shard "$shard" "$@"
else
    echo "core: did not run; it takes cargo-mutants (cargo install --locked cargo-mutants), and tree-sitter and tree-sitter-rust (pip)"
fi
if .venv/bin/python -c "import mutmut" 2>/dev/null; then
    # In a copy, whose package has the place that mutmut looks in.
    copy=target/mutants/package
    rm -rf $copy && mkdir -p $copy && cp -r tests pyproject.toml README.md $copy && cp -r python $copy/src
    (cd $copy && ../../../.venv/bin/python -m mutmut run; ../../../.venv/bin/python -m mutmut results)
else
    echo "package: did not run; it takes mutmut (pip)"
fi
