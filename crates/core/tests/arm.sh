#!/bin/sh
# Runs the tests named as arguments (default: the digests) for AArch64 under qemu-user. Installs nothing and says what is missing.
set -eu
target=aarch64-unknown-linux-gnu

need() {
    echo "make test-arm needs $1" >&2
    exit 1
}
command -v aarch64-linux-gnu-gcc >/dev/null ||
    need 'a linker and the C library for AArch64 (Debian: gcc-aarch64-linux-gnu, libc6-dev-arm64-cross)'
test -e /usr/aarch64-linux-gnu/lib/libc.so.6 || need 'the C library for AArch64 (Debian: libc6-dev-arm64-cross)'
command -v qemu-aarch64 >/dev/null || need 'qemu for programs of other processors (Debian: qemu-user)'

# A toolchain with the standard library for the target, or with its sources: rustup's, or the distribution's.
build_std=
for bin in "$(dirname "$(command -v rustc)")" /usr/bin; do
    test -x "$bin/rustc" && test -x "$bin/cargo" || continue
    lib=$("$bin/rustc" --print sysroot)/lib/rustlib
    if test -d "$lib/$target"; then
        break
    elif test -f "$lib/src/rust/library/Cargo.toml"; then
        build_std=-Zbuild-std=std,panic_abort,test
        break
    fi
    bin=
done
test -n "$bin" || need 'the standard library for AArch64: `rustup target add '$target'`, or its sources to build it from
(`rustup component add rust-src`; Debian: rustc-web, cargo-web, rust-web-src)'

PATH=$bin:$PATH
export PATH
export RUSTC_BOOTSTRAP=1 # -Zbuild-std is not stable
export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc
export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER='qemu-aarch64 -L /usr/aarch64-linux-gnu'
# shellcheck disable=SC2086
exec cargo test $build_std --package restitution-core --locked --target $target --target-dir target/arm --test core -- "${@:-digest::}"
