#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the seeds of tests/fuzz/corpus: small inputs of every kind that each target knows. What fuzzing found stands beside
them under other names and is kept.

  tests/fuzz/seeds.py
"""
import base64
import pathlib
import struct
import zlib

CORPUS = pathlib.Path(__file__).parent / "corpus"


def write(target: str, name: str, data) -> None:
    folder = CORPUS / target
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(data if isinstance(data, bytes) else data.encode())


# ---- PNG

def chunk(kind: bytes, data: bytes, crc: int | None = None) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data) if crc is None else crc)


HEAD = b"\x89PNG\r\n\x1a\n"
CHANNELS = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}


def png(width=5, height=4, depth=8, kind=2, interlace=0, extra=b"", filters=(0, 1, 2, 3, 4), end=True) -> bytes:
    bits = depth * CHANNELS[kind]
    state = 1

    def rows(w, h):
        nonlocal state
        out = b""
        for y in range(h if w else 0):
            out += bytes([filters[y % len(filters)]])
            for _ in range((w * bits + 7) // 8):
                state = state * 1103515245 + 12345 & 0x7FFFFFFF
                out += bytes([state >> 16 & (1 if kind == 3 and depth == 8 else 255)])
        return out

    if interlace:
        raw = b""
        for x0, y0, dx, dy in ((0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)):
            raw += rows((width - x0 + dx - 1) // dx if width > x0 else 0, (height - y0 + dy - 1) // dy if height > y0 else 0)
    else:
        raw = rows(width, height)
    palette = chunk(b"PLTE", bytes(range(3 * min(256, 1 << depth)))[:768] if depth < 8 else bytes(i % 256 for i in range(768))) if kind == 3 else b""
    body = chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, depth, kind, 0, 0, interlace))
    return HEAD + body + palette + extra + chunk(b"IDAT", zlib.compress(raw)) + (chunk(b"IEND", b"") if end else b"")


def pngs() -> None:
    for kind, depths in ((0, (1, 2, 4, 8, 16)), (2, (8, 16)), (3, (1, 2, 4, 8)), (4, (8, 16)), (6, (8, 16))):
        for depth in depths:
            write("png", f"kind{kind}_{depth}.png", png(depth=depth, kind=kind))
            write("png", f"kind{kind}_{depth}_interlaced.png", png(depth=depth, kind=kind, interlace=1))
    write("png", "one_pixel.png", png(1, 1))
    write("png", "grey_transparent.png", png(kind=0, extra=chunk(b"tRNS", b"\0\7")))
    write("png", "colour_transparent.png", png(extra=chunk(b"tRNS", b"\0\1\0\2\0\3")))
    write("png", "palette_transparent.png", png(kind=3, extra=chunk(b"tRNS", b"\0\x80")))
    write("png", "chunks.png", png(extra=chunk(b"gAMA", struct.pack(">I", 45455)) + chunk(b"sRGB", b"\0") + chunk(b"pHYs", struct.pack(">IIB", 1, 1, 0))
                                   + chunk(b"tEXt", b"Comment\0hello") + chunk(b"zTXt", b"a\0\0" + zlib.compress(b"b" * 100))
                                   + chunk(b"iCCP", b"p\0\0" + zlib.compress(b"c" * 200)) + chunk(b"bKGD", b"\0\0\0\0\0\0")))
    write("png", "no_end.png", png(end=False))
    write("png", "bomb.png", HEAD + chunk(b"IHDR", struct.pack(">IIBBBBB", 60000, 60000, 8, 2, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(bytes(9999))) + chunk(b"IEND", b""))
    write("png", "text_bomb.png", png(extra=chunk(b"zTXt", b"a\0\0" + zlib.compress(bytes(3 << 20), 9))))
    write("png", "wrong_crc.png", HEAD + chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 2, 8, 2, 0, 0, 0), 1))


# ---- linear pictures: the first byte says the format

def pictures() -> None:
    floats = struct.pack("<12f", *range(10), float("inf"), float("nan"))
    write("pictures", "pfm", b"\0PF\n2 2\n-1.0\n" + floats)
    write("pictures", "pfm_grey_big_endian", b"\0Pf\n2 2\n1.0\n" + floats[:16])
    rows = lambda pixels: b"".join(pixels)  # noqa: E731
    write("pictures", "hdr_flat", b"\2#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 3\n" + rows([b"\x80\x40\x20\x81"] * 6))
    run = b"\2\2\0\x08" + b"\x88\x40" + b"\x88\x41" + b"\x08ABCDEFGH" + b"\x88\x81"
    write("pictures", "hdr_runs", b"\2#?RADIANCE\nEXPOSURE=1\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 8\n" + run * 2)
    header = b"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2, 3), }"
    header += b" " * (118 - len(header) - 1) + b"\n"
    write("pictures", "npy", b"\3\x93NUMPY\1\0" + struct.pack("<H", len(header)) + header + floats)

    def attribute(name, kind, data):
        return name + b"\0" + kind + b"\0" + struct.pack("<I", len(data)) + data

    def exr(compression, half):
        channels = b"".join(n + b"\0" + struct.pack("<IBxxxII", 1 if half else 2, 0, 1, 1) for n in (b"B", b"G", b"R")) + b"\0"
        box = struct.pack("<4i", 0, 0, 1, 1)
        head = struct.pack("<II", 20000630, 2) + attribute(b"channels", b"chlist", channels) + attribute(b"compression", b"compression", bytes([compression]))
        head += attribute(b"dataWindow", b"box2i", box) + attribute(b"displayWindow", b"box2i", box) + attribute(b"lineOrder", b"lineOrder", b"\0")
        head += attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1)) + attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0))
        head += attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0"
        values = [struct.pack("<2e" if half else "<2f", 1.5, 2) * 3 for _ in range(2)]
        if compression in (0,):
            blocks = [struct.pack("<iI", y, len(v)) + v for y, v in enumerate(values)]
        else:
            raw = b"".join(values)
            half_way = (len(raw) + 1) // 2
            mixed = bytearray(len(raw))
            mixed[:half_way], mixed[half_way:] = raw[0::2], raw[1::2]
            delta = bytes([mixed[0]]) + bytes((mixed[i] - mixed[i - 1] + 128) & 255 for i in range(1, len(mixed)))
            packed = zlib.compress(delta)
            blocks = [struct.pack("<iI", 0, len(packed)) + packed] if compression == 3 else []
        place, table = len(head) + 8 * len(blocks), b""
        for block in blocks:
            table += struct.pack("<Q", place)
            place += len(block)
        return head + table + b"".join(blocks)

    for compression, half in ((0, False), (0, True), (3, False), (3, True)):
        write("pictures", f"exr_{compression}_{'half' if half else 'float'}", b"\1" + exr(compression, half))


# ---- SVG path data, text

def paths() -> None:
    for name, data in {
        "square": "M0 0H10V10H0Z", "relative": "m1,1 l5,0 0,5-5,0z", "cubic": "M0 0C1 2 3 4 5 6S7 8 9 0z", "quadratic": "M0 0Q5 5 10 0T20 0Z",
        "arcs": "M10 10a5 5 0 0 1 10 0A3 4 30 1 0 5 5z", "arc_flags": "M0 0a1 1 0 01.5.5z", "numbers": "M.5.5-1e3+2.5E-2 1.L0,0z",
        "star": "M0 -10L6 8L-9 -3L9 -3L-6 8Z", "holes": "M0 0H9V9H0ZM3 3V6H6V3Z", "same_twice": "M0 0H9V9H0ZM0 0H9V9H0Z",
        "degenerate": "M0 0L0 0L0 0ZM5 5Z", "huge": "M1e308 1e308L-1e308 0 1e-300 3Z", "bad": "M0 0L", "no_move": "L1 1",
        "flat_arc": "M0 0A0 5 0 0 0 9 9z", "many": "M0 0" + "l3 1 -2 4 1 -6" * 20 + "z",
    }.items():
        write("path", name, data)


def texts() -> None:
    for name, data in {"word": "0Penumbra", "lines": "1a\nb\n\nc", "kerning": "2AVAToWaLT", "accents": "3\u00e4\u00e9\u00f1\u0142\u0416\u03a9", "missing": "4\u4e16\U0001f600",
                       "controls": "5\t\r\u200b\u0301", "empty": "6", "spaces": "7   ", "mixed": "8%&@#\u00df\ufb01"}.items():
        write("text", name, data)
    write("text", "no_utf8", b"9\xff\xc3\x28\xf0\x9f")


# ---- HTTP

SCENE = '{"version": 1, "canvas": {"width": 4, "height": 3}, "sky": {"radiance": 0.5}}'


def requests() -> None:
    def post(headers="", body=SCENE, length=True, type_="application/json"):
        return ("POST /v1/render HTTP/1.1\r\nHost: x\r\n" + (f"Content-Type: {type_}\r\n" if type_ else "")
                + (f"Content-Length: {len(body)}\r\n" if length else "") + headers + "\r\n" + body)

    chunked = "Transfer-Encoding: chunked\r\n"
    size = f"{len(SCENE):x}"
    for name, data in {
        "render": post(), "render_pfm": post("Accept: image/x-pfm;q=0.5, image/png;q=0.1\r\n"), "nothing_fits": post("Accept: text/html\r\n"),
        "anew": post("Cache-Control: no-cache\r\n"), "any_tag": post("If-None-Match: *\r\n"), "tags": post('If-None-Match: "a", W/"b"\r\n'),
        "request_id": post("X-Request-Id: a.b-c_1\r\n"), "bad_request_id": post("X-Request-Id: a b\r\n"), "no_type": post(type_=""),
        "type_parameters": post(type_="application/vnd.x+json; charset=UTF-8"), "wrong_type": post(type_="text/plain"), "charset": post(type_="application/json; charset=latin1"),
        "gzip": post("Content-Encoding: gzip\r\n"), "expect": post("Expect: 100-continue\r\n"), "range": post("Range: bytes=0-3\r\n"),
        "not_json": post(body="{"), "invalid": post(body='{"version": 1}'), "no_body": post(body=""), "short_body": post()[:-9],
        "chunked": post(chunked, f"{size};a=b\r\n{SCENE}\r\n0\r\n\r\n", length=False), "trailer": post(chunked, f"{size}\r\n{SCENE}\r\n0\r\nA: b\r\n\r\n", length=False),
        "bad_chunk": post(chunked, f"zz\r\n{SCENE}", length=False), "huge_chunk": post(chunked, "ffffffffffffffff\r\n{", length=False),
        "both_lengths": post(chunked), "two_lengths": post("Content-Length: 3\r\n"), "negative": post("Content-Length: -1\r\n", length=False),
        "huge": post("Content-Length: 99999999999\r\n", length=False), "obsolete_fold": "GET /healthz HTTP/1.1\r\nHost: x\r\nA: b\r\n c\r\n\r\n",
        "get": "GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n", "pipelined": "GET /healthz HTTP/1.1\r\nHost: x\r\n\r\nGET /readyz HTTP/1.1\r\nHost: x\r\n\r\n",
        "head": "HEAD /v1/info HTTP/1.1\r\nHost: x\r\n\r\n", "problem": "GET /problems/invalid-scene HTTP/1.1\r\nHost: x\r\n\r\n",
        "http_1_0": "GET / HTTP/1.0\r\n\r\n", "close": "GET / HTTP/1.1\r\nConnection: close\r\n\r\n", "options": "OPTIONS * HTTP/1.1\r\nHost: x\r\n\r\n",
        "delete": "DELETE /v1/render HTTP/1.1\r\nHost: x\r\n\r\n", "nowhere": "GET /a%20b/%00/..?x=%zz&y HTTP/1.1\r\nHost: x\r\n\r\n", "query": post().replace("render ", "render?a=b "),
        "absolute": "GET http://x/healthz HTTP/1.1\r\nHost: y\r\n\r\n", "brew": "BREW /coffee HTCPCP/1.0\r\n\r\n", "bare_newlines": "GET /healthz HTTP/1.1\nHost: x\n\n",
        "no_colon": "GET /healthz HTTP/1.1\r\nHost x\r\n\r\n", "remote_addr": "GET /healthz HTTP/1.1\r\nREMOTE_ADDR: 1.2.3.4\r\n\r\n",
        "body_on_get": "GET /healthz HTTP/1.1\r\nContent-Length: 35\r\n\r\nGET /smuggled HTTP/1.1\r\nHost: x\r\n\r\n",
        "multipart": post("", "--b\r\nContent-Disposition: form-data; name=\"a\"\r\n\r\n1\r\n--b--\r\n", type_="multipart/form-data; boundary=b"),
        "form": post("", "a=b&c=%41", type_="application/x-www-form-urlencoded"),
        "websocket": "GET / HTTP/1.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n\r\n", "http_2": "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", "many_headers": "GET / HTTP/1.1\r\n" + "A: b\r\n" * 101 + "\r\n",
        "long_address": "GET /" + "a" * 8200 + " HTTP/1.1\r\n\r\n", "half": "GET / HT", "tls": "\x16\x03\x01\x02\x00\x01",
    }.items():
        write("http", name, data)


# ---- scenes beyond tests/corpus

def scenes() -> None:
    picture = base64.b64encode(png(kind=3, depth=2)).decode()
    head = '{"version": 1, "canvas": {"width": 16, "height": 16}, '
    for name, rest in {
        "picture": f'"shapes": [{{"type": "bitmap", "image": "data:image/png;base64,{picture}", "position": [1, 1], "size": [9, 9]}}]}}',
        "deep_colour": '"sky": {"radiance": {"color": {"color": "#fff"}, "intensity": 1e999}}}',
        "surrogates": '"a\\ud800\\udc00\\ud800": "\\u0000"}',
        "coincident": '"shapes": [' + ", ".join('{"type": "rect", "center": [5, 5], "size": [4, 4], "emission": 1}' for _ in range(4)) + "]}",
    }.items():
        write("scene", name + ".json", head + rest)


if __name__ == "__main__":
    pngs()
    pictures()
    paths()
    texts()
    requests()
    scenes()
