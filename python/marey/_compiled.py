"""Why the compiled part of the package cannot be imported, in one sentence."""

import pathlib
import sys


def explain(error: ImportError) -> ImportError:
    """The error that a user reads in place of the loader's `error`."""
    folder = pathlib.Path(__file__).parent
    built = sorted(path.name for path in folder.glob("_core*.so"))
    version = f"{sys.version_info.major}{sys.version_info.minor}"
    if not built:
        why = f"{folder} holds the sources only; import the package from build/release/python, which script/demo builds, or install it (docs/install.md)"
    elif not any(f"-{version}-" in name or ".abi3." in name for name in built):
        why = f"{folder / built[0]} was built for another Python than this one ({sys.version.split()[0]}); run the one in its name, or build with this one"
    else:
        why = f"{folder / built[0]} cannot be loaded: {error}"
    return ImportError(f"marey: {why}", name="marey._core")
