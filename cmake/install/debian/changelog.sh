#!/bin/sh
# SPDX-License-Identifier: MIT
#
# changelog: writes a package's changelog in Debian's format. Its date is the date of the last
# commit that changed CHANGELOG.md; without git it is SOURCE_DATE_EPOCH, or the current date.
# Usage: changelog.sh PACKAGE VERSION FILE.gz
set -eu
date=$(git log -1 --format=%ct -- CHANGELOG.md 2>/dev/null || true)
date=${date:-${SOURCE_DATE_EPOCH:-$(date +%s)}}
mkdir -p "${3%/*}"
gzip -9n >"$3" <<END
$1 ($2) unstable; urgency=medium

  * Release of IceSoC; see changelog.gz for the changes.

 -- The IceSoC authors <packages@icesoc.example>  $(LC_ALL=C date -u -R -d "@$date")
END
