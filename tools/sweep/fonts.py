"""Fonts of Debian's packages: downloads, unpacks and lists them."""

import hashlib
import os
import struct
import subprocess
import sys
from pathlib import Path


class Face:
    """One face of a font file."""

    def __init__(self, source, name, path, index):
        self.source, self.name, self.path, self.index = source, name, path, index
        self.hash = hashlib.sha256(path.read_bytes()).hexdigest()[:16]


def collect(listed, cache):
    """The faces of the listed packages, without repeats, and notes about packages that gave none."""
    faces, notes, seen = [], [], set()
    for line in listed.read_text().splitlines():
        fields = line.split("#")[0].split()
        if not fields:
            continue
        package, most = fields[0], int(fields[1]) if len(fields) > 1 else None
        folder, problem = unpacked(package, cache)
        if problem:
            notes.append((package, problem))
            continue
        files = sorted(p for p in folder.rglob("*") if p.suffix.lower() in (".ttf", ".ttc") and p.is_file() and not p.is_symlink())
        if not files:
            notes.append((package, "has no TrueType files"))
        for path in spread(files, most):
            for index in range(faces_in(path)):
                face = Face(package, path.name, path, index)
                if (face.hash, index) not in seen:
                    seen.add((face.hash, index))
                    faces.append(face)
    return faces, notes


def unpacked(package, cache):
    """The folder of a package's files, or what is wrong."""
    folder = cache / "fonts" / package
    if folder.exists():
        return folder, None
    debs = cache / "debs"
    debs.mkdir(parents=True, exist_ok=True)
    if not list(debs.glob(f"{package}_*.deb")):
        print(f"downloading {package}", file=sys.stderr)
        # apt's own user may not write into the cache.
        command = ["apt-get", "download", "-qq", "-o", "APT::Sandbox::User=" + os.environ.get("USER", "root"), package]
        done = subprocess.run(command, cwd=debs, capture_output=True, text=True)
        if done.returncode:
            problem = (done.stderr.strip().splitlines() or ["apt-get failed"])[-1].removeprefix("E: ")
            return None, f"is not downloaded: {problem}"
    part = folder.with_name(package + ".part")
    part.mkdir(parents=True, exist_ok=True)
    done = subprocess.run(["dpkg-deb", "-x", sorted(debs.glob(f"{package}_*.deb"))[-1], part], capture_output=True, text=True)
    if done.returncode:
        return None, f"is not unpacked: {done.stderr.strip()}"
    part.replace(folder)
    return folder, None


def spread(files, most):
    """At most so many of the files, at even distances."""
    if most is None or len(files) <= most:
        return files
    return [files[at * len(files) // most] for at in range(most)]


def faces_in(path):
    """The number of faces in a file; one in a plain font, whatever it contains."""
    with open(path, "rb") as file:
        head = file.read(12)
    return struct.unpack(">I", head[8:12])[0] if head[:4] == b"ttcf" and len(head) == 12 else 1
