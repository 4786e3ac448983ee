#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The committed bundle is that of the committed sources, carries its licences, and its lock file names no host."""
import hashlib
import re
import sys

from program import ROOT

page = ROOT / "src/view/page"
bundle = (page / "viewer.bundle.js").read_text()
faults = []

digest = hashlib.sha256()
for name in ["package.json", *sorted(f"viewer/{p.name}" for p in (page / "viewer").glob("*.mjs"))]:
    digest.update(name.encode() + b"\0" + (page / name).read_bytes())
if digest.hexdigest() not in bundle:
    faults.append("viewer.bundle.js is older than its sources: cd src/view/page && npm ci && npm run bundle")
for words in ("GPL-3.0-or-later", "The MIT License", "three.js authors", "Permission is hereby granted"):
    if words not in bundle[:3000]:
        faults.append(f"viewer.bundle.js does not say '{words}'")
if re.search(r"</script", bundle, re.I):
    faults.append("viewer.bundle.js would end the script element it stands in")
if ')pcbmesh_page"' in bundle:
    faults.append("viewer.bundle.js would end the string it stands in")
for name in ("package.json", "package-lock.json"):
    if re.search(r"https?://|\"resolved\"", (page / name).read_text()):
        faults.append(f"{name} names a host; npm install --omit-lockfile-registry-resolved")
for fault in faults:
    print(fault)
sys.exit(1 if faults else 0)
