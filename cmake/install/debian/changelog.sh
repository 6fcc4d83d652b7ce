#!/bin/sh
# SPDX-License-Identifier: MIT
#
# changelog: writes a package's changelog in Debian's format; the date is SOURCE_DATE_EPOCH, else of
# the newest commit. Usage: changelog.sh PACKAGE VERSION FILE.gz
set -eu
date=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || date +%s)}
mkdir -p "${3%/*}"
gzip -9n >"$3" <<END
$1 ($2) unstable; urgency=medium

  * Release of IceSoC; see changelog.gz for the changes.

 -- The IceSoC authors <packages@icesoc.example>  $(LC_ALL=C date -u -R -d "@$date")
END
