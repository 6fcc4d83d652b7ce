#!/bin/sh
# SPDX-License-Identifier: MIT
#
# fetch: brings what Debian has but the packages in use leave out, without touching the system.
#   cmake/fetch.sh ice DIR    internal transport headers of the installed ZeroC Ice, into DIR
#   cmake/fetch.sh ghdl DIR   GHDL 5 (GHDL 2's Verilog output is wrong for `case`), DIR/ghdl runs it
#   cmake/fetch.sh nextpnr DIR   nextpnr for ECP5, DIR/nextpnr-ecp5 runs it; names of files are absolute
#   cmake/fetch.sh foreign DIR   the third-party cores that examples/foreign/files.list names, into DIR; from
#                             ICESOC_RAW, a copy of raw.githubusercontent.com, if it is set
#   cmake/fetch.sh svd DIR    ARM's schema of CMSIS-SVD files, 1.3.9; from ICESOC_RAW, too
#   cmake/fetch.sh lz4 DIR    the source of LZ4, which unpacks firmware on the chip
#   cmake/fetch.sh sodium DIR the sources of libsodium that check a signature, for the chip
#   cmake/fetch.sh page DIR   Tabulator and uPlot for the pages, as DIR/libraries.js and .css; from ICESOC_NPM, a mirror of
#                             registry.npmjs.org, if it is set; if there is no network both are empty, and there is no DIR/done
#   cmake/fetch.sh wavedrom DIR   WaveDrom, which draws the pages' waveforms; from ICESOC_NPM, too; exit status 77: there is no network
#   cmake/fetch.sh zeroc DIR  ZeroC's test suites for Python, 3.7.8, into DIR; exit status 77: there is no network
# Kept in ${XDG_CACHE_HOME:-~/.cache}/icesoc, so that a second build needs no network.

set -eu

what=$1 target=$2
cache=${XDG_CACHE_HOME:-$HOME/.cache}/icesoc
keyring=/usr/share/keyrings/debian-archive-keyring.gpg

fail() {
    echo "fetch: $*" >&2
    exit 1
}

# A word for the shell, whatever is in it.
quoted() { printf "'%s'" "$(printf %s "$1" | sed "s/'/'\\\\''/g")"; }

# The Debian mirror that this machine uses.
mirror() {
    found=$(cat /etc/apt/sources.list /etc/apt/sources.list.d/*.sources /etc/apt/sources.list.d/*.list 2>/dev/null |
        sed -n 's/^URIs: *\(http[^ ]*debian\/\{0,1\}\)$/\1/p; s/^deb .*\(http[^ ]*\/debian\/\{0,1\}\) .*main.*/\1/p' | head -n 1)
    echo "${found:-http://deb.debian.org/debian}"
}

# apt with lists of its own. $1 types (deb or deb-src), $2 suites, the rest apt's arguments.
private_apt() {
    types=$1 suites=$2
    shift 2
    mkdir -p "$work/lists/partial" "$work/archives/partial"
    cat >"$work/private.sources" <<EOF
Types: $types
URIs: $(mirror)
Suites: $suites
Components: main
Signed-By: $keyring
EOF
    apt-get -qq -o Dir::Etc::sourcelist="$work/private.sources" -o Dir::Etc::sourceparts=/dev/null \
        -o Dir::State::lists="$work/lists" -o Dir::Cache::archives="$work/archives" \
        -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache= -o APT::Sandbox::User=root \
        -o APT::Get::List-Cleanup=0 "$@"
}

codename() { sed -n 's/^VERSION_CODENAME=//p' /etc/os-release; }

ice_source() { (cd "$work" && private_apt deb-src "$1" --download-only source "zeroc-ice$2"); }

fetch_ice() {
    version=$(dpkg-query -W -f '${source:Version}' libzeroc-ice-dev 2>/dev/null) ||
        fail "libzeroc-ice-dev is not installed; run 'make setup'"
    keep=$cache/ice-$version
    if [ ! -f "$keep/done" ]; then
        echo "Fetching the headers of ZeroC Ice $version (source package, 15 MB) ..."
        if private_apt deb-src "$(codename)" update && ice_source "$(codename)" "=$version"; then
            :
        elif private_apt deb-src bookworm update && ice_source bookworm ''; then
            # Transports are internal to Ice, but did not change between 3.7.8 and 3.7.10.
            echo "fetch: the mirror $(mirror) has no source of zeroc-ice $version;" \
                "using the headers of Debian 12's 3.7.8, of the same series" >&2
        else
            fail "cannot get the source of zeroc-ice $version from $(mirror); check the network, then run make again"
        fi
        (cd "$work" && dpkg-source --no-check --extract zeroc-ice_*.dsc tree >/dev/null) ||
            fail "cannot unpack the source of zeroc-ice $version"
        mkdir -p "$keep/Ice"
        cp "$work"/tree/cpp/src/Ice/*.h "$keep/Ice/"
        touch "$keep/done"
    fi
    rm -rf "$target"
    mkdir -p "$target"
    ln -sfn "$keep/Ice" "$target/Ice"
}

# Unpacks packages of the Debian release $1 into $keep/root; $2 says what they are.
unpacked() {
    suite=$1 name=$2
    shift 2
    [ ! -f "$keep/done" ] || return 0
    echo "Fetching $name from Debian's $suite, kept apart from the system ..."
    private_apt deb "$suite" update || fail "cannot reach the Debian mirror $(mirror)"
    (cd "$work" && private_apt deb "$suite" download "$@") || fail "cannot get $name from $(mirror)"
    mkdir -p "$keep/root"
    for package in "$work"/*.deb; do
        dpkg -x "$package" "$keep/root"
    done
    touch "$keep/done"
}

fetch_ghdl() {
    mkdir -p "$target"
    major=$(ghdl --version 2>/dev/null | sed -n 's/^GHDL \([0-9]*\).*/\1/p')
    if [ "${major:-0}" -ge 5 ]; then
        printf '#!/bin/sh\nexec ghdl "$@"\n' >"$target/ghdl"
        chmod +x "$target/ghdl"
        return
    fi
    keep=$cache/ghdl5
    unpacked trixie 'GHDL 5 (7 MB)' ghdl-mcode ghdl-common libgnat-14 libc6 libgcc-s1 libstdc++6 zlib1g gcc-14-base
    root=$keep/root
    lib=$(dirname "$(find "$root" -name 'ld-linux-*.so.2' -type f | head -n 1)")
    [ -n "$lib" ] || lib=$root/usr/lib/x86_64-linux-gnu
    cat >"$target/ghdl" <<EOF
#!/bin/sh
root=$(quoted "$root") lib=$(quoted "$lib")
GHDL_PREFIX=\$root/usr/lib/ghdl/mcode/vhdl exec "\$lib/ld-linux-x86-64.so.2" \\
    --library-path "\$root/usr/lib/x86_64-linux-gnu" "\$root/usr/bin/ghdl-mcode" "\$@"
EOF
    chmod +x "$target/ghdl"
}

# The program looks for its chips where Debian would install them: the copy here looks in its own folder, as long a name.
fetch_nextpnr() {
    mkdir -p "$target"
    keep=$cache/nextpnr-0.7
    boost='libboost-filesystem1.83.0 libboost-iostreams1.83.0 libboost-program-options1.83.0 libboost-thread1.83.0'
    # shellcheck disable=SC2086
    unpacked trixie 'nextpnr for ECP5 (14 MB)' nextpnr-ecp5 nextpnr-ecp5-chipdb $boost libpython3.13 libpython3.13-minimal \
        libpython3.13-stdlib libexpat1 zlib1g libbz2-1.0 liblzma5 libzstd1 libc6 libgcc-s1 libstdc++6 gcc-14-base
    root=$keep/root
    program=$root/usr/bin/nextpnr-ecp5-here
    ln -sfn usr/share/nextpnr "$root/npr"
    LC_ALL=C sed 's#/usr/share/nextpnr/#/proc/self/cwd/npr/#g' "$root/usr/bin/nextpnr-ecp5" >"$program"
    lib=$root/usr/lib/$(uname -m)-linux-gnu
    cat >"$target/nextpnr-ecp5" <<EOF
#!/bin/sh
root=$(quoted "$root") lib=$(quoted "$lib")
cd "\$root" && PYTHONHOME=\$root/usr exec "\$lib/$(basename "$(find "$lib" -name 'ld-linux-*')")" --library-path "\$lib" \\
    "\$root/usr/bin/nextpnr-ecp5-here" "\$@"
EOF
    chmod +x "$target/nextpnr-ecp5"
}

# Brings a file to $kept: its checksum says that it is the one that was tested. $1: address, $2: checksum. Exit status 1: there
# is no network.
kept_file() {
    kept=$cache/foreign/$2
    mkdir -p "$cache/foreign"
    [ ! -f "$kept" ] || return 0
    url=$1
    echo "Fetching ${url##*/} ..."
    curl --fail --silent --show-error --location --connect-timeout 10 --max-time 60 -o "$work/file" "$url" || return 1
    echo "$2  $work/file" | sha256sum --check --status || fail "$url is not the file that was tested (sha256)"
    mv "$work/file" "$kept"
}

github=${ICESOC_RAW:-https://raw.githubusercontent.com}

fetch_foreign() {
    list=$(dirname "$0")/../examples/foreign/files.list
    mkdir -p "$target"
    grep -v '^#' "$list" | while read -r repository commit path sum; do
        kept_file "$github/$repository/$commit/$path" "$sum" ||
            fail "cannot get $url: is there a network? Only the examples of foreign cores need it"
        mkdir -p "$target/$(basename "$repository")"
        cp "$kept" "$target/$(basename "$repository")/$(basename "$path")"
    done
}

fetch_svd() {
    kept_file "$github/ARM-software/CMSIS_5/51f8f89612c8330c0116479cfe3a2cb04c390e2b/CMSIS/Utilities/CMSIS-SVD.xsd" \
        eee4bfe949f80708b00cccb4833e71da3766b0489a4cdfa2dae225d541688d89 || {
        echo "fetch: cannot get ARM's schema: is there a network? Only the check of icesoc.svd needs it" >&2
        exit 77
    }
    mkdir -p "$target"
    cp "$kept" "$target/CMSIS-SVD.xsd"
}

npm=${ICESOC_NPM:-https://registry.npmjs.org}

fetch_wavedrom() {
    kept_file "$npm/wavedrom/-/wavedrom-3.5.0.tgz" 7efce288c7e1e6f4072ba93345592ccd1e09442817a91cc2f3b351b777b6b0e9 || {
        echo "fetch: cannot get WaveDrom: is there a network? Only drawings of waveforms need it" >&2
        exit 77
    }
    mkdir -p "$target"
    tar -xzf "$kept" -C "$target" --strip-components=1 package/wavedrom.unpkg.min.js
}

# Adds a package of npm's to $work/libraries.js and .css, each file below its licence. $1: name, $2: version, $3: checksum, then its
# files. Exit status 1: there is no network.
npm_files() {
    (kept_file "$npm/$1/-/$1-$2.tgz" "$3") || return 1
    mkdir -p "$work/$1"
    tar -xzf "$cache/foreign/$3" -C "$work/$1" --strip-components=1 || fail "cannot unpack $1"
    name="$1 $2" folder=$work/$1
    shift 3
    for file in "$@"; do
        { printf '/*! %s\n' "$name" && cat "$folder/LICENSE" && printf '\n*/\n' && sed '/sourceMappingURL=/d' "$folder/dist/$file" && echo; } \
            >>"$work/libraries.${file##*.}"
    done
}

# The build goes on without: pages then say so, and since there is no DIR/done the next build tries again.
fetch_page() {
    mkdir -p "$target"
    if npm_files tabulator-tables 6.5.3 a3aeb833e5cf924c8a686fa6748c1070c5fde8e605e0b1734000c35b78571a9b js/tabulator.min.js css/tabulator_simple.min.css &&
        npm_files uplot 1.6.32 4b8a8191e425658e3ea8c8c1314b0fc679c861ee3a1af2b20c7b16ba50b5133d uPlot.iife.min.js uPlot.min.css; then
        mv "$work/libraries.js" "$work/libraries.css" "$target"
        touch "$target/done"
    else
        echo "fetch: cannot get Tabulator and uPlot, is there a network? Pages have plain tables and no drawn charts; the next build tries again" >&2
        touch "$target/libraries.js" "$target/libraries.css"
    fi
}

# Brings a released source as Debian keeps it to $work/file: its checksum says that it is the one that was tested. $1: path in
# the pool, $2: checksum. Exit status 1: there is no network.
released() {
    url=$(mirror)
    url=${url%/}/pool/main/$1
    echo "Fetching $url ..."
    /usr/lib/apt/apt-helper -qq -o APT::Sandbox::User=root download-file "$url" "$work/file" "SHA256:$2" >/dev/null
}

# $1: name for people and the cache; $2: path in the pool; $3: checksum; $4: folder in it, $5 levels deep.
fetch_source() {
    keep=$cache/$1
    if [ ! -f "$keep/done" ]; then
        released "$2" "$3" || fail "cannot get the source of $1 from $(mirror): check the network, then run make again"
        mkdir -p "$keep"
        tar -xzf "$work/file" -C "$keep" --strip-components="$5" "$4" || fail "cannot unpack $1"
        touch "$keep/done"
    fi
    rm -rf "$target"
    mkdir -p "$target"
    cp -r "$keep/." "$target"
}

fetch_zeroc() {
    keep=$cache/zeroc-3.7.8
    if [ ! -f "$keep/done" ]; then
        released z/zeroc-ice/zeroc-ice_3.7.8.orig.tar.xz c48f9e43d65e2b1f5e2af747fd86e7718b5e344b4e9d9a7dc73a84dd0be61f66 || {
            echo "fetch: cannot get ZeroC's test suites: is there a network? Only these need it" >&2
            exit 77
        }
        mkdir -p "$keep"
        tar -xJf "$work/file" -C "$keep" --strip-components=3 ice-3.7.8/python/test || fail "cannot unpack ZeroC's test suites"
        touch "$keep/done"
    fi
    mkdir -p "$target"
    cp -r "$keep/." "$target"
}

mkdir -p "$cache"
# One at a time: two builds may want the same.
exec 9>"$cache/lock"
flock 9
work=$(mktemp -d "$cache/work.XXXXXX")
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM
case $what in
ice) fetch_ice ;;
ghdl) fetch_ghdl ;;
nextpnr) fetch_nextpnr ;;
foreign) fetch_foreign ;;
svd) fetch_svd ;;
page) fetch_page ;;
wavedrom) fetch_wavedrom ;;
lz4) fetch_source lz4-1.9.4 l/lz4/lz4_1.9.4.orig.tar.gz 0b0e3aa07c8c063ddf40b082bdf7e37a1562bda40a0ff5272957f3e987e0e54b lz4-1.9.4/lib 2 ;;
sodium) fetch_source sodium-1.0.18 libs/libsodium/libsodium_1.0.18.orig.tar.gz \
    d59323c6b712a1519a5daf710b68f5e7fde57040845ffec53850911f10a5d4f4 libsodium-1.0.18/src/libsodium 3 ;;
zeroc) fetch_zeroc ;;
*) fail "unknown: $what" ;;
esac
