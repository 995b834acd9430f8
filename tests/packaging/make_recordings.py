#!/usr/bin/env python3
"""Small recordings for commands.sh.
make_recordings.py small FOLDER: under the names that docs/rawlogs.md uses, a folder of ScanNet's layout, a
log of ElasticFusion with its camera, a ROS bag.
make_recordings.py tum IMAGES TRUTH FOLDER: a folder like a TUM sequence, from the images of 160x120 pixels
beside a rawlog of pointplane-simulate and its ground truth."""
import gzip
import os
import shutil
import struct
import sys
import zlib

WIDTH, HEIGHT, FRAMES = 64, 48, 4


def colour(frame):
    """RGB, row by row: a pattern that moves."""
    return bytes(
        (37 * (x + frame) + 91 * y + c) % 251
        for y in range(HEIGHT) for x in range(WIDTH) for c in range(3))


def depth(frame):
    """Millimetres."""
    return [1500 + 4 * x + 3 * y + frame for y in range(HEIGHT) for x in range(WIDTH)]


def write(path, data):
    os.makedirs(os.path.dirname(path) or '.', exist_ok=True)
    with open(path, 'wb') as file:
        file.write(data)


def png(bits, kind, pixels, width=WIDTH, height=HEIGHT):
    """kind: 0 = gray, 2 = RGB. pixels: bytes as PNG wants them."""
    def chunk(name, data):
        return (struct.pack('>I', len(data)) + name + data +
                struct.pack('>I', zlib.crc32(name + data)))
    row = len(pixels) // height
    rows = b''.join(b'\0' + pixels[y * row:(y + 1) * row] for y in range(height))
    return (b'\x89PNG\r\n\x1a\n' +
            chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, bits, kind, 0, 0, 0)) +
            chunk(b'IDAT', zlib.compress(rows)) + chunk(b'IEND', b''))


def write_scan_net(folder):
    intrinsics = b'60 0 31.5 0\n0 60 23.5 0\n0 0 1 0\n0 0 0 1\n'
    for name in ('color', 'depth'):
        write(f'{folder}/intrinsic/intrinsic_{name}.txt', intrinsics)
    for i in range(FRAMES):
        write(f'{folder}/color/{i}.png', png(8, 2, colour(i)))
        values = depth(i)
        write(f'{folder}/depth/{i}.png', png(16, 0, struct.pack(f'>{len(values)}H', *values)))


def write_klg(path):
    out = struct.pack('<i', FRAMES)
    for i in range(FRAMES):
        values = depth(i)
        images = (zlib.compress(struct.pack(f'<{len(values)}H', *values)), colour(i))
        out += struct.pack('<qii', 33333 * i, *map(len, images)) + b''.join(images)
    write(path, out)


def text(value):
    return struct.pack('<I', len(value)) + value.encode()


def ros_header(frame):
    return struct.pack('<III', frame, 1000, frame * 33333333) + text('optical')


def ros_image(frame, encoding, size, data):
    return (ros_header(frame) + struct.pack('<II', HEIGHT, WIDTH) + text(encoding) +
            struct.pack('<BII', 0, WIDTH * size, len(data)) + data)


def ros_camera():
    k = [60, 0, 31.5, 0, 60, 23.5, 0, 0, 1]
    p = [60, 0, 31.5, 0, 0, 60, 23.5, 0, 0, 0, 1, 0]
    numbers = [5] + [0.0] * 5 + k + [1, 0, 0, 0, 1, 0, 0, 0, 1] + p
    return (ros_header(0) + struct.pack('<II', HEIGHT, WIDTH) + text('plumb_bob') +
            struct.pack('<I35d', *numbers) + struct.pack('<IIIIIIB', *[0] * 7))


def record(data, **fields):
    header = b''
    for name, value in fields.items():
        field = name.encode() + b'=' + value
        header += struct.pack('<I', len(field)) + field
    return struct.pack('<I', len(header)) + header + struct.pack('<I', len(data)) + data


def write_bag(path):
    """ROS bag 2.0 with one chunk that is not compressed."""
    image, info = 'sensor_msgs/Image', 'sensor_msgs/CameraInfo'
    sums = {image: '060021388200f6f0f447d0fcd9c64743', info: 'c9a58c1b0b154e0e6da7578cb991d214'}
    topics = [('/camera/rgb/image_color', image), ('/camera/depth/image', image),
              ('/camera/rgb/camera_info', info), ('/camera/depth/camera_info', info)]
    connections = []
    for number, (topic, kind) in enumerate(topics):
        about = record(b'', topic=topic.encode(), type=kind.encode(), md5sum=sums[kind].encode(),
                       message_definition=b'#')[4:-4]
        connections.append(record(
            about, op=b'\x07', conn=struct.pack('<I', number), topic=topic.encode()))
    messages = [(n, 0, ros_camera()) for n in (2, 3)]
    for i in range(FRAMES):
        values = depth(i)
        messages.append((0, i, ros_image(i, 'rgb8', 3, colour(i))))
        messages.append(
            (1, i, ros_image(i, '16UC1', 2, struct.pack(f'<{len(values)}H', *values))))
    chunk, places = b''.join(connections), {n: [] for n in range(len(topics))}
    for number, i, data in messages:
        time = struct.pack('<II', 1000, i * 33333333)
        places[number].append(time + struct.pack('<I', len(chunk)))
        chunk += record(data, op=b'\x02', conn=struct.pack('<I', number), time=time)
    body = record(chunk, op=b'\x05', compression=b'none', size=struct.pack('<I', len(chunk)))
    for number, entries in places.items():
        body += record(b''.join(entries), op=b'\x04', ver=struct.pack('<I', 1),
                       conn=struct.pack('<I', number), count=struct.pack('<I', len(entries)))
    magic, size = b'#ROSBAG V2.0\n', 4096
    start = len(magic) + size
    head = dict(op=b'\x03', index_pos=struct.pack('<Q', start + len(body)),
                conn_count=struct.pack('<I', len(topics)), chunk_count=struct.pack('<I', 1))
    padding = b' ' * (size - len(record(b'', **head)))
    counts = b''.join(struct.pack('<II', n, len(e)) for n, e in places.items())
    index = record(counts, op=b'\x06', ver=struct.pack('<I', 1), chunk_pos=struct.pack('<Q', start),
                   start_time=struct.pack('<II', 1000, 0),
                   end_time=struct.pack('<II', 1000, (FRAMES - 1) * 33333333),
                   count=struct.pack('<I', len(topics)))
    write(path, magic + record(padding, **head) + body + b''.join(connections) + index)


def write_small(folder):
    write_scan_net(f'{folder}/scene0000_00')
    write_klg(f'{folder}/dyson_lab.klg')
    write(f'{folder}/camera.txt', b'60 60 31.5 23.5 0 0 0 0 0 64 48 1000\n')
    write_bag(f'{folder}/recording.bag')


def write_tum(images, truth, folder):
    lists = {'rgb': '', 'depth': ''}
    for name in sorted(os.listdir(images)):
        stamp, kind = name.rsplit('_', 1)
        with open(f'{images}/{name}', 'rb') as file:
            data = file.read()
        if kind == 'depth.bin':
            rows, columns, *values = struct.unpack('<2I19200H', gzip.decompress(data))
            data = png(16, 0, struct.pack('>19200H', *values), columns, rows)
        what = 'depth' if kind == 'depth.bin' else 'rgb'
        write(f'{folder}/{what}/{stamp}.png', data)
        lists[what] += f'{stamp} {what}/{stamp}.png\n'
    for what, lines in lists.items():
        write(f'{folder}/{what}.txt', lines.encode())
    write(f'{folder}/camera.txt', b'131.25 131.25 79.5 59.5 0 0 0 0 0 160 120 5000\n')
    shutil.copy(truth, f'{folder}/groundtruth.txt')


{'small': write_small, 'tum': write_tum}[sys.argv[1]](*sys.argv[2:])
