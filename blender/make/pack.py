# SPDX-License-Identifier: MIT
"""pack.py FOLDER SCHEMA...: lays the add-on and the schemas into FOLDER/papilla_blender and packs FOLDER/papilla_blender.zip.

Same sources, same bytes: names in order, one time for all.
"""
import pathlib
import shutil
import sys
import zipfile

OLDEST = (1980, 1, 1, 0, 0, 0)  # that a zip file can say


def lay_out(source, target, schemas):
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__"))
    (target / "schemas").mkdir()
    for schema in schemas:
        shutil.copy(schema, target / "schemas")


def pack(package, archive):
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as written:
        names = sorted(p.relative_to(package.parent).as_posix() for p in package.rglob("*") if p.is_file())
        for name in names:
            entry = zipfile.ZipInfo(name, OLDEST)
            entry.external_attr = 0o100644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            written.writestr(entry, (package.parent / name).read_bytes())


def main(folder, *schemas):
    folder = pathlib.Path(folder)
    package = folder / "papilla_blender"
    lay_out(pathlib.Path("papilla_blender"), package, schemas)
    pack(package, folder / "papilla_blender.zip")


main(*sys.argv[1:])
