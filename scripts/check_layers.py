#!/usr/bin/env python3
"""Checks that #include lines follow the dependency picture in docs/architecture.md, and that each
source includes the header of its name first, which shows that the header stands alone."""

import pathlib
import re
import sys

# What each folder may include besides itself. The longest matching folder owns a file.
ALLOWED = {
    "common/units": set(),
    "common/posix": set(),
    "common/log": set(),
    "common/random": set(),
    "common/statistics": set(),
    "common/geometry": {"common/units"},
    "common/scenario": {"common/units", "common/geometry", "common/city"},
    "common/city": {"common/units"},
    "common/city/import": {"common/units", "common/random", "common/city"},
    "common/city/geometry": {"common/units", "common/city"},
    "common/city/generate": {"common/units", "common/random", "common/city"},
    "common/city/export": {"common/units", "common/city"},
    "proto": set(),
    "common/city/transfer": {"common/city", "proto"},
    "common/ipc": {"common/posix", "common/statistics", "proto"},
}
SHARED = set(ALLOWED)
PURE = {"common/units", "common/random", "common/statistics", "common/geometry", "common/scenario",
        "common/city", "common/city/geometry"}
ALLOWED |= {
    "world/dynamics": PURE,
    "world/surroundings": PURE,
    "world/collision": PURE | {"world/surroundings", "world/dynamics"},
    "world/sensors": PURE | {"world/surroundings", "world/dynamics"},
    "world/actuation": PURE | {"proto"},
    "camera/view": PURE,
    "camera/scene": PURE | {"common/city/export", "camera/view"},
    "camera/gl": PURE | {"camera/view", "camera/scene"},
    "netsim/makers": set(),
    "netsim/channel": PURE | {"netsim/makers"},
    "netsim/phy": PURE | {"netsim/makers", "netsim/channel"},
    "netsim/link": PURE | {"netsim/phy"},
    "netsim/mac": PURE | {"netsim/makers", "netsim/phy", "netsim/kernel"},
    "netsim/kernel": PURE,
    "netsim/air": PURE | {"netsim/kernel", "netsim/channel", "netsim/phy", "netsim/mac"},
    "netsim/capture": PURE | {"netsim/phy", "netsim/mac", "netsim/air"},
    "uav-agent/flight": PURE,
    "uav-agent/missions": PURE | {"uav-agent/flight"},
    "uav-agent/air": PURE | {"proto", "uav-agent/flight", "uav-agent/missions"},
    "uav-agent/sdk": PURE | {"uav-agent/flight"},
    "uav-agent/sdk/sim": PURE
    | {"common/posix", "common/ipc", "proto", "uav-agent/flight", "uav-agent/sdk"},
    "ground-station/core": PURE | {"proto"},
    "orchestrator/plan": PURE | {"proto"},
    "orchestrator/netlink": {"common/posix", "proto"},
    "orchestrator/init": {"common/posix", "common/ipc", "proto"},
    "orchestrator/node": {"common/posix", "common/ipc", "common/statistics", "proto",
                          "orchestrator/netlink"},
    "orchestrator/fetch": set(),
    "orchestrator/results": PURE | {"proto", "common/posix", "orchestrator/plan"},
}
for component in ("world", "camera", "netsim", "uav-agent", "ground-station", "orchestrator"):
    # The rest of a component (app/, *_main.cc) may use its own folders, and no other component's.
    ALLOWED[component] = SHARED | {m for m in ALLOWED if m.startswith(component + "/")}
ALLOWED["tests"] = set(ALLOWED)

INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)


def owner_of(path: str) -> str | None:
    """The folder that owns a path given from the root, or None for a path outside all of them."""
    owners = [folder for folder in ALLOWED if path.startswith(folder + "/")]
    return max(owners, key=len, default=None)


def violations(root: pathlib.Path):
    for top in sorted({folder.split("/")[0] for folder in ALLOWED}):
        for file in sorted((root / top).rglob("*.*")):
            if file.suffix not in {".h", ".cc"}:
                continue
            path = file.relative_to(root).as_posix()
            owner = owner_of(path)
            if owner is None:
                yield f"{path}: belongs to no folder that scripts/check_layers.py knows"
                continue
            includes = INCLUDE.findall(file.read_text(encoding="utf-8"))
            header = file.with_suffix(".h").relative_to(root).as_posix()
            if file.suffix == ".cc" and (root / header).exists() and includes[:1] != [header]:
                yield f'{path}: does not include "{header}" before all others'
            for included in includes:
                if owner_of(included) not in ALLOWED[owner] | {owner}:
                    yield f'{path}: {owner} may not include "{included}"'


def main() -> int:
    found = list(violations(pathlib.Path(sys.argv[1])))
    for line in found:
        print(line, file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
