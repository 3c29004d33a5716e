#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Sends a scene to a running Penumbra and saves the picture. Standard library only, Python 3.9 or later.

Exit codes: 0 the picture is there, 1 no answer, the service failed or the picture cannot be written, 2 the
request is wrong.
"""
import argparse
import http.client
import json
import os
import pathlib
import sys
import urllib.error
import urllib.request


def explain(status: int, body: bytes) -> str:
    """A refusal as text: a title, then one line for each problem of the scene."""
    try:
        problem = json.loads(body)
        lines = [": ".join(filter(None, [problem.get("title"), problem.get("detail")]))]
        for error in problem.get("errors", []):
            place = error.get("pointer", "")
            if error.get("line"):
                spot = f"line {error['line']}, column {error['column']}"
                place += f" ({spot})" if place else spot
            text = error.get("detail") or error.get("message", "")
            lines.append(f"  {place}: {text}")
    except (ValueError, AttributeError, TypeError):
        lines = [body.decode("utf-8", "replace")]
    return f"the service answered {status}\n" + "\n".join(lines)


def render(scene: bytes, url: str, accept: str, timeout: float) -> bytes:
    request = urllib.request.Request(
        url.rstrip("/") + "/v1/render",
        data=scene,
        headers={"Content-Type": "application/json", "Accept": f"{accept}, application/problem+json"},
    )
    with urllib.request.urlopen(request, timeout=timeout) as answer:
        return answer.read()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", help="scene file, or - for standard input")
    parser.add_argument("-o", "--output", default="scene.png",
                        help="picture (default scene.png); - is standard output; *.pfm asks for the linear picture")
    parser.add_argument("--url", default=os.environ.get("PENUMBRA_URL", "http://127.0.0.1:8080"))
    parser.add_argument("--timeout", type=float, default=120, metavar="SECONDS")
    arguments = parser.parse_args()

    accept = "image/x-pfm" if arguments.output.endswith(".pfm") else "image/png"
    try:
        scene = sys.stdin.buffer.read() if arguments.scene == "-" else pathlib.Path(arguments.scene).read_bytes()
    except OSError as error:
        print(f"render.py: cannot read {arguments.scene}: {error.strerror}", file=sys.stderr)
        return 2
    try:
        picture = render(scene, arguments.url, accept, arguments.timeout)
    except urllib.error.HTTPError as refusal:
        print("render.py: " + explain(refusal.code, refusal.read()), file=sys.stderr)
        return 2 if refusal.code < 500 else 1
    except (OSError, ValueError, http.client.HTTPException) as error:
        print(f"render.py: no answer from {arguments.url}: {getattr(error, 'reason', error)}", file=sys.stderr)
        return 1
    try:
        if arguments.output == "-":
            sys.stdout.buffer.write(picture)
            sys.stdout.buffer.flush()
        else:
            pathlib.Path(arguments.output).write_bytes(picture)
    except OSError as error:
        print(f"render.py: cannot write {arguments.output}: {error.strerror}", file=sys.stderr)
        return 1
    if arguments.output != "-":
        print(f"{arguments.output}: {len(picture)} bytes")
    return 0


if __name__ == "__main__":
    sys.exit(main())
