# SPDX-License-Identifier: MIT
"""sbom: writes the bill of materials of a release, in SPDX 2.3
(https://spdx.github.io/spdx-spec/v2.3).

It lists every file of the source archive with its licence, the other files of the release with
their licences, and everything that the build needs: the Debian packages of cmake/setup.sh and the
sources that icesoc.util.fetch downloads.
"""
import hashlib
import json
import re
import time

from icesoc.util import fetch

# Licences of the libraries that programs link to; other packages state their own licences.
LICENCES = {
    "libzeroc-ice-dev": "GPL-2.0-only", "libsodium-dev": "ISC", "libmcpp-dev": "BSD-2-Clause",
    "libssl-dev": "Apache-2.0", "liblz4-dev": "BSD-2-Clause", "libfmt-dev": "MIT",
    "libcli11-dev": "BSD-3-Clause", "nlohmann-json3-dev": "MIT", "libgtest-dev": "BSD-3-Clause"}
LICENCES |= dict.fromkeys(("python3-zeroc-ice", "zeroc-ice-compilers", "zeroc-ice-slice"),
                          "GPL-2.0-only")
# Licences of the Debian packages of a release, as in cmake/install/debian/*.copyright; all others
# are MIT.
OWN_LICENCES = {"icesoc-ground": "MIT AND GPL-2.0-only",
                "icesoc-sim": "MIT AND (LGPL-3.0-only OR Artistic-2.0)"}
AUTHORS = "Organization: The IceSoC authors"
FETCHED = (("lz4", fetch.LZ4, "BSD-2-Clause"), ("libsodium", fetch.SODIUM, "ISC"))


def identifier(text):
    """Returns an SPDX identifier for a name."""
    return "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", text)


def debian(setup):
    """Returns the Debian packages that cmake/setup.sh lists: (name, purpose)."""
    found = []
    for block in re.findall(r"^(?:packages|deb|rest)='\n(.*?)'", setup, re.M | re.S):
        found += [tuple(line.split(" ", 1)) for line in block.strip().splitlines()]
    return found


def checksum(kind, digest):
    """Returns an SPDX checksum. The digest is given in hexadecimal digits, or as a hash object."""
    text = digest if isinstance(digest, str) else digest.hexdigest()
    return {"algorithm": kind, "checksumValue": text}


def file_entry(number, name, data):
    """Returns the SPDX entry of a file of the source archive."""
    found = re.search(rb"SPDX-License-Identifier: ([\w.+-]+)", data[:2000])
    licence = found[1].decode() if found else None
    return {"SPDXID": f"SPDXRef-File-{number}", "fileName": f"./{name}",
            "checksums": [checksum("SHA1", hashlib.sha1(data)),
                          checksum("SHA256", hashlib.sha256(data))],
            "licenseConcluded": licence or "MIT", "licenseInfoInFiles": [licence or "NONE"],
            "copyrightText": "NOASSERTION"}


def package(name, version, licence="NOASSERTION", **more):
    return {"SPDXID": identifier(f"Package-{name}"), "name": name, "versionInfo": version,
            "downloadLocation": "NOASSERTION", "filesAnalyzed": False,
            "licenseConcluded": licence, "licenseDeclared": licence,
            "copyrightText": "NOASSERTION", **more}


def document(version, commit, seconds, sources, artifacts):
    """Returns the text of the document. `sources` are the files of the source archive, name to
    bytes; `artifacts` the other files of the release, name to SHA-256."""
    files = [file_entry(number, name, sources[name]) for number, name in enumerate(sorted(sources))]
    sha1 = sorted(its["checksums"][0]["checksumValue"] for its in files)
    holder = re.search(r"^Copyright.*$", sources["LICENSE"].decode(), re.M)[0]
    code = hashlib.sha1("".join(sha1).encode()).hexdigest()
    found = {its["licenseInfoInFiles"][0] for its in files} - {"NONE"}
    main = package("icesoc", version, "MIT", filesAnalyzed=True, supplier=AUTHORS,
                   packageVerificationCode={"packageVerificationCodeValue": code},
                   licenseInfoFromFiles=sorted(found), hasFiles=[its["SPDXID"] for its in files])
    main["copyrightText"] = holder
    number, digest = fetch.ICEJS
    page = package("npm-ice", number, "GPL-2.0-only",
                   comment="Ice for JavaScript, for the page of the gateway",
                   downloadLocation=f"https://registry.npmjs.org/ice/-/ice-{number}.tgz",
                   checksums=[checksum("SHA256", digest)])
    packages, links = [main, page], [("SPDXRef-DOCUMENT", "DESCRIBES", main["SPDXID"])]
    for name, digest in sorted(artifacts.items()):
        component = name.partition("_")[0]
        # The site contains scripts and styles of other projects.
        licence = "NOASSERTION" if name.endswith("-site.tar.gz") else "MIT"
        its = package(name, version, OWN_LICENCES.get(component, licence), packageFileName=name,
                      checksums=[checksum("SHA256", digest)])
        packages.append(its)
        links.append((its["SPDXID"], "GENERATED_FROM", main["SPDXID"]))
        if component == "icesoc-ground":
            links.append((its["SPDXID"], "CONTAINS", page["SPDXID"]))
    for name, purpose in debian(sources["cmake/setup.sh"].decode()):
        its = package(f"debian-{name}", "NOASSERTION", LICENCES.get(name, "NOASSERTION"),
                      comment=purpose)
        its["externalRefs"] = [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                                "referenceLocator": f"pkg:deb/debian/{name}"}]
        packages.append(its)
        links.append((its["SPDXID"], "BUILD_DEPENDENCY_OF", main["SPDXID"]))
    for name, (path, digest), licence in FETCHED:
        its = package(f"source-{name}", re.search(r"_([\d.]+)\.orig", path)[1], licence,
                      downloadLocation=f"http://deb.debian.org/debian/pool/main/{path}",
                      checksums=[checksum("SHA256", digest)])
        packages.append(its)
        links.append((main["SPDXID"], "STATIC_LINK", its["SPDXID"]))
    return json.dumps({
        "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT",
        "name": f"icesoc-{version}",
        "documentNamespace": f"https://spdx.org/spdxdocs/icesoc-{version}-{commit}",
        "creationInfo": {"created": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(seconds)),
                         "creators": ["Tool: icesoc release", AUTHORS]},
        "packages": packages, "files": files,
        "relationships": [{"spdxElementId": a, "relationshipType": kind, "relatedSpdxElement": b}
                          for a, kind, b in links]}, indent=1) + "\n"
