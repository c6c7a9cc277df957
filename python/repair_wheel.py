"""`auditwheel repair`, but the wheel carries the libraries of X11 and GLib too: a system without a screen, as a server or a container, has none.

Usage: repair_wheel.py WHEEL FOLDER
"""

import json
import pathlib
import sys
import tempfile

import auditwheel.policy
from auditwheel.libc import Libc
from auditwheel.main import main

FROM_THE_SYSTEM = ("libatomic", "libgcc_s", "libstdc++", "libm", "libmvec", "libanl", "libdl", "librt", "libc", "libnsl", "libutil", "libpthread", "libresolv")

wheel, folder = sys.argv[1:]
with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
    policies = json.loads(auditwheel.policy._POLICY_JSON_MAP[Libc.GLIBC].read_text())
    for policy in policies:
        policy["lib_whitelist"] = [name for name in policy["lib_whitelist"] if name.split(".so")[0] in FROM_THE_SYSTEM]
    json.dump(policies, file)
    file.flush()
    auditwheel.policy._POLICY_JSON_MAP[Libc.GLIBC] = pathlib.Path(file.name)
    sys.argv = ["auditwheel", "repair", "--strip", "-w", folder, wheel]
    sys.exit(main())
