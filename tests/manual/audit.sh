# Known weaknesses of the dependencies. A check whose tool or data is not here says that it did not run, which is no failure; a
# weakness that is found is one.
status=0
check() {
    name=$1
    shift
    if ! command -v "$1" >/dev/null 2>&1; then
        echo "$name: did not run, $1 is not installed"
        return
    fi
    if output=$("$@" 2>&1); then
        echo "$name: nothing found"
    elif echo "$output" | grep -qiE "fetch|network|resolve|connection|offline|couldn't (load|open)|failed to (load|open)"; then
        echo "$name: did not run, it has no data here: $(echo "$output" | tail -1)"
    else
        echo "$output"
        echo "$name: found the above"
        status=1
    fi
}
check "advisories for Rust (cargo audit)" cargo-audit audit --no-fetch --stale
check "advisories, licences and sources of Rust (cargo deny)" cargo-deny --offline check
check "advisories for Python (pip-audit)" pip-audit --local --progress-spinner off
exit $status
