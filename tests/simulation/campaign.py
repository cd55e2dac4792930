"""What campaigns share: simulate a scene, verify its run, say how both went."""

import pathlib
import re
import subprocess
import tempfile


def run(*command: str, limit: float) -> tuple:
    """Exit status and text; a command that takes too long is interrupted, and ends by itself."""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        text, _ = process.communicate(timeout=limit)
    except subprocess.TimeoutExpired:
        process.send_signal(2)
        text, _ = process.communicate()
    return process.returncode, text


def fact(text: str, label: str) -> str:
    found = re.search(rf"^  {label} +(.*)$", text, re.MULTILINE)
    return found[1] if found else "?"


def simulate_and_verify(tool: str, scene: pathlib.Path, duration: float, limit: float,
                        name: str) -> int:
    """Prints a line; 1 if the run is not proven, 3 if time was lost or over the limit, else 0."""
    with tempfile.TemporaryDirectory() as folder:
        record = str(pathlib.Path(folder) / "run.jsonl")
        simulated, text = run(tool, "simulate", str(scene), "--duration", str(duration),
                              "-o", record, limit=limit)
        verified, proof = run(tool, "verify", record, limit=limit)
    if simulated == 2:
        print(text, end="")
    print(f"{name:55} {['whole', '', 'error', 'early'][simulated]:6} "
          f"{['proven', 'REFUTED', 'BROKEN', 'not proven'][verified]:11} steps {fact(text, 'steps')}; "
          f"lost {fact(text, 'time lost')}; {fact(text, 'took')}; least {fact(proof, 'least')}",
          flush=True)
    return 1 if verified else simulated
