#!/usr/bin/python3
"""Draws a map of points, x y z in a line, obliquely from above: map_picture.py MAP.txt OUT.png
Needs the package python3-numpy."""
import struct
import sys
import zlib

import numpy as np

WIDTH, HEIGHT, PITCH_DEG, NEAR_SHARE = 640, 400, 35, 0.98
SKY = (255, 255, 255)


def colours(values):
    """Blue, green, yellow from 0 to 1."""
    stops = np.array([(68, 1, 84), (59, 82, 139), (33, 145, 140), (94, 201, 98), (253, 231, 37)])
    at = np.clip(values, 0, 1) * (len(stops) - 1)
    low = np.minimum(at.astype(int), len(stops) - 2)
    part = (at - low)[:, None]
    return ((1 - part) * stops[low] + part * stops[low + 1]).astype(np.uint8)


def picture(points):
    centre = np.median(points, axis=0)
    near = np.linalg.norm(points - centre, axis=1)
    points = points[near < np.quantile(near, NEAR_SHARE)] - centre
    pitch = np.radians(PITCH_DEG)
    right, forward = -points[:, 1], points[:, 0]  # x forward, y left, z up
    up = points[:, 2] * np.cos(pitch) + forward * np.sin(pitch)
    depth = forward * np.cos(pitch) - points[:, 2] * np.sin(pitch)
    span = [np.quantile(v, 0.998) - np.quantile(v, 0.002) for v in (right, up)]
    scale = 0.94 * min(WIDTH / span[0], HEIGHT / span[1])
    middle = [(np.quantile(v, 0.998) + np.quantile(v, 0.002)) / 2 for v in (right, up)]
    u = np.round(WIDTH / 2 + scale * (right - middle[0])).astype(int)
    v = np.round(HEIGHT / 2 - scale * (up - middle[1])).astype(int)
    seen = (u >= 0) & (u < WIDTH) & (v >= 0) & (v < HEIGHT)
    order = np.argsort(-depth[seen], kind="stable")  # the nearest is drawn last
    low, high = np.quantile(points[:, 2], (0.02, 0.98))
    out = np.full((HEIGHT, WIDTH, 3), SKY, np.uint8)
    out[v[seen][order], u[seen][order]] = colours((points[:, 2] - low) / (high - low))[seen][order]
    return out


def write_png(path, image):
    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    rows = b"".join(b"\0" + row.tobytes() for row in image)
    header = struct.pack(">IIBBBBB", image.shape[1], image.shape[0], 8, 2, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header))
        file.write(chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    write_png(sys.argv[2], picture(np.loadtxt(sys.argv[1], ndmin=2)[:, :3]))
