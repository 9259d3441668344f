"""A bill of materials (SBOM) of packages and everything compiled into them, in CycloneDX's JSON."""

import json
import subprocess
from pathlib import Path

import tomllib

ROOT = Path(__file__).resolve().parents[1]


def bill_of_materials(name, version, packages):
    """The bill of a product that consists of these packages of the workspace: on any platform, with all features."""
    command = ["cargo", "metadata", "--locked", "--format-version", "1", "--all-features"]
    metadata = json.loads(subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout)
    known = {package["id"]: package for package in metadata["packages"]}
    uses = {node["id"]: [used["pkg"] for used in node["deps"] if is_compiled_in(used)] for node in metadata["resolve"]["nodes"]}
    roots = sorted(id for id, package in known.items() if package["name"] in packages and package["source"] is None)
    needed, rest = set(), list(roots)
    while rest:
        package = rest.pop()
        if package not in needed:
            needed.add(package)
            rest += uses[package]
    ordered = sorted(needed, key=lambda id: (known[id]["name"], known[id]["version"]))
    product = {"type": "application", "bom-ref": name, "name": name, "version": version}
    relations = {name: roots, **{reference(known[id]): uses[id] for id in ordered}}
    sums = checksums()
    return {
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": {"component": product},
        "components": [component(known[id], sums) for id in ordered],
        "dependencies": [
            {"ref": ref, "dependsOn": sorted({reference(known[id]) for id in used})} for ref, used in relations.items()
        ],
    }  # fmt: skip


def is_compiled_in(used):
    """Tests and build scripts are not shipped."""
    return any(kind["kind"] is None for kind in used["dep_kinds"])


def checksums():
    """SHA-256 of the registry's packages, by name and version."""
    locked = tomllib.loads((ROOT / "Cargo.lock").read_text(encoding="utf-8"))["package"]
    return {(package["name"], package["version"]): package.get("checksum") for package in locked}


def reference(package):
    return f"pkg:cargo/{package['name']}@{package['version']}"


def component(package, sums):
    found = {"type": "library", "bom-ref": reference(package), "name": package["name"], "version": package["version"]}
    found["purl"] = reference(package)
    if package["license"]:
        # Cargo's older form of "OR".
        found["licenses"] = [{"expression": package["license"].replace("/", " OR ")}]
    checksum = sums.get((package["name"], package["version"]))
    if checksum:
        found["hashes"] = [{"alg": "SHA-256", "content": checksum}]
    return found
