"""Peers of haptic devices for tests, on real sockets: spacenavd, the Haply Inverse Service, a page of a browser."""

import base64
import hashlib
import json
import pathlib
import socket
import struct
import threading


class Service:
    """Serves one connection after another in a thread, until it is closed."""

    def __init__(self, listener: socket.socket):
        self.listener = listener
        self.stopped = threading.Event()
        self.thread = threading.Thread(target=self.run)
        self.thread.start()

    def run(self):
        self.listener.settimeout(0.02)
        while not self.stopped.is_set():
            try:
                connection, _ = self.listener.accept()
            except socket.timeout:
                continue
            with connection:
                connection.settimeout(0.02)
                try:
                    self.serve(connection)
                except ConnectionError:
                    pass  # The tool has ended.

    def receive(self, connection: socket.socket) -> bytes:
        """What comes next. Empty when the service is closed."""
        while not self.stopped.is_set():
            try:
                received = connection.recv(65536)
            except socket.timeout:
                continue
            if not received:
                raise ConnectionError("the peer is gone")
            return received
        return b""

    def close(self):
        self.stopped.set()
        self.thread.join()
        self.listener.close()


class SpaceNavigator(Service):
    """A spacenavd of version 1, whose cap is pressed down: the tool goes down at 0.2 m/s."""

    def __init__(self, path: pathlib.Path):
        self.path = str(path)
        listener = socket.socket(socket.AF_UNIX)
        listener.bind(self.path)
        listener.listen()
        super().__init__(listener)

    def serve(self, connection: socket.socket):
        self.receive(connection)
        connection.sendall(struct.pack("<I", 0x7FAA5501))
        while not self.stopped.wait(0.02):
            connection.sendall(struct.pack("<8i", 0, 0, -350, 0, 0, 0, 0, 16))  # Its y axis is up.


class InverseService(Service):
    """A Haply Inverse Service of either generation, whose handle is 3 cm below the origin."""

    def __init__(self, is_since_3_5: bool):
        self.is_since_3_5 = is_since_3_5
        self.forces = []  # [N]  As they came, in the key of the generation.
        listener = socket.create_server(("127.0.0.1", 0))
        self.address = f"127.0.0.1:{listener.getsockname()[1]}"
        super().__init__(listener)

    def state(self) -> dict:
        device = {"device_id": "049D", "config": {"type": "inverse3"}, "status": {"ready": True},
                  "state": {"cursor_position": {"x": 0, "y": -0.14, "z": 0.14},
                            "cursor_velocity": {"x": 0, "y": 0, "z": 0}}}
        return {**({"session_id": 7} if self.is_since_3_5 else {}), "inverse3": [device]}

    def serve(self, connection: socket.socket):
        head = b""
        while b"\r\n\r\n" not in head:
            head += self.receive(connection)
        key = head.lower().split(b"sec-websocket-key:")[1].split(b"\r\n")[0]
        key = head[head.lower().index(key):][:len(key)].strip()
        accept = base64.b64encode(hashlib.sha1(key + b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11").digest()).decode()
        connection.sendall(("HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                            f"Sec-WebSocket-Accept: {accept}\r\n\r\n").encode())
        self.send(connection)
        received = b""
        while not self.stopped.is_set():
            received += self.receive(connection)
            while (frame := self.frame(received)) is not None:
                payload, received = frame
                self.take(payload)
                self.send(connection)

    def send(self, connection: socket.socket):
        text = json.dumps(self.state()).encode()
        connection.sendall(b"\x81\x7e" + struct.pack(">H", len(text)) + text)

    @staticmethod
    def frame(received: bytes):
        """The payload of a frame of a client and the bytes behind it; None while it is not there."""
        if len(received) < 8:
            return None
        length, at = received[1] & 0x7F, 2
        if length == 126:
            length, at = struct.unpack(">H", received[2:4])[0], 4
        mask, begin = received[at:at + 4], at + 4
        if len(received) < begin + length:
            return None
        payload = bytes(byte ^ mask[k % 4] for k, byte in enumerate(received[begin:begin + length]))
        return payload, received[begin + length:]

    def take(self, payload: bytes):
        if not payload.startswith(b"{"):
            raise ConnectionError("closed")
        key = "vector" if self.is_since_3_5 else "values"
        for device in json.loads(payload).get("inverse3", []):
            self.forces.append(device["commands"]["set_cursor_force"][key]["z"])


class Page:
    """A page of a browser that moves the tool: its WebSocket, without the browser."""

    def __init__(self, port: int, origin: str):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=20)
        self.socket.sendall(f"GET /live HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nOrigin: {origin}\r\n"
                            "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n".encode())
        self.received = self.socket.makefile("rb")
        self.status = int(self.received.readline().split()[1])
        while self.received.readline().strip():
            pass

    def send(self, text: str):
        payload = text.encode()
        self.socket.sendall(b"\x81" + bytes([0x80 | len(payload)]) + bytes(4) + payload)  # Masked by zeros.

    def picture(self) -> dict:
        """The next one."""
        length = self.received.read(2)[1]
        if length == 126:
            length = struct.unpack(">H", self.received.read(2))[0]
        return json.loads(self.received.read(length))

    def close(self):
        self.received.close()
        self.socket.close()
