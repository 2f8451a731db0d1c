"""Xvfb's frame buffer (an XWD file of 32 bits a pixel) as a PNG: screen_to_png.py XWD PNG"""

import struct
import sys
import zlib

data = open(sys.argv[1], "rb").read()
header = struct.unpack(">25I", data[:100])
size, width, height, row_bytes, colors = header[0], header[4], header[5], header[12], header[19]
start = size + colors * 12


def line(y):
    raw = data[start + y * row_bytes : start + y * row_bytes + 4 * width]
    return b"\0" + b"".join(bytes((raw[i + 2], raw[i + 1], raw[i])) for i in range(0, 4 * width, 4))


def chunk(kind, body):
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


with open(sys.argv[2], "wb") as png:
    png.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)))
    png.write(chunk(b"IDAT", zlib.compress(b"".join(line(y) for y in range(height)))) + chunk(b"IEND", b""))
