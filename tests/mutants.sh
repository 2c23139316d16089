# Mutation: each tool changes the sources one place at a time and tells which changes no test noticed. A tool that is not here says so.
# The first argument is the part of the core's mutants to try, as 0/256.
shard=${1:-0/256}
if command -v cargo-mutants >/dev/null 2>&1; then
    cargo mutants --package restitution-core --shard "$shard" --timeout 300 --output target/mutants || true
    echo "core: shard $shard is done, survivors are in target/mutants/mutants.out/missed.txt"
else
    echo "core: did not run, cargo-mutants is not installed"
fi
if .venv/bin/python -c "import mutmut" 2>/dev/null; then
    .venv/bin/python -m mutmut run "restitution._arrays*" "restitution._files*" "restitution._recorded*" "restitution._reduce*" || true
    .venv/bin/python -m mutmut results
else
    echo "package: did not run, mutmut is not installed"
fi
