"""Installs what the tests need: packages of the distribution and targets of Rust."""

import os
import subprocess


def run(*command):
    print("$", *command, flush=True)
    subprocess.run(command, check=True)


def install_packages(*packages):
    """With apt, as root or by sudo."""
    become_root = [] if os.geteuid() == 0 else ["sudo"]
    run(*become_root, "apt-get", "update", "-qq")
    run(*become_root, "apt-get", "install", "-qq", "-y", "--no-install-recommends", *packages)


def add_rust_targets(*targets):
    run("rustup", "target", "add", *targets)
