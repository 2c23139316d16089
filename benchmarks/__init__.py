"""Speed of `restitution` beside what one would use otherwise, as ratios measured in one run.

`python -m benchmarks` first checks that every peer computes the same physics, then times them in turns. To
add a peer, write one file in `peers` that offers `rows()` and name it in `peers.available`.
"""
