#!/bin/sh
# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
#
# Make the branch and the tag that bloom releases ballscrew_msgs from: msg_defs of the last commit
# as the top of a repository, for bloom takes a package from there. Nothing is pushed.
set -eu
cd "$(git rev-parse --show-toplevel)"
branch=interfaces
version=$(git show HEAD:msg_defs/package.xml | sed -n 's/.*<version>\(.*\)<\/version>.*/\1/p')
tag=interfaces/$version

refuse() {
    echo "release_interfaces: $1" >&2
    exit 2
}

[ -n "$version" ] || refuse 'msg_defs/package.xml states no <version>'
[ -z "$(git status --porcelain msg_defs)" ] || refuse 'msg_defs differs from the last commit: commit it first'
if git rev-parse -q --verify "refs/tags/$tag" >/dev/null; then
    refuse "tag $tag is there: raise <version> in msg_defs/package.xml, which no release has twice"
fi
parent=$(git rev-parse -q --verify "refs/heads/$branch" || true)
commit=$(git commit-tree 'HEAD:msg_defs' ${parent:+-p "$parent"} -m "ballscrew_msgs $version")
git update-ref "refs/heads/$branch" "$commit"
git tag "$tag" "$commit"
echo "made branch $branch and tag $tag; release them by:"
echo "git push origin $branch $tag"
echo 'bloom-release ballscrew_msgs --rosdistro jazzy'
