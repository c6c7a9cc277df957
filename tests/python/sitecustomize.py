"""Finds `marey._core` among what is built in: Python before 3.11.4 looks there for top-level names alone."""
import importlib.machinery
import importlib.util
import sys


class BuiltInCore:
    @staticmethod
    def find_spec(name, path=None, target=None):
        if name == "marey._core" and name in sys.builtin_module_names:
            return importlib.util.spec_from_loader(name, importlib.machinery.BuiltinImporter)
        return None


sys.meta_path.insert(0, BuiltInCore)
