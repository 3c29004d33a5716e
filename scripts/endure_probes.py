# SPDX-License-Identifier: MIT
"""For scripts/endure: how long /livez takes while something else goes on."""
import socket
import threading
import time


def percentile(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))]


def probe_times(port, ending, times, pause=0.02):
    """How long /livez takes, connecting included, as a kubelet asks: one after another until `ending`."""
    while not ending.is_set():
        start, status = time.perf_counter(), 0
        try:
            with socket.create_connection(("127.0.0.1", port), timeout=30) as client:
                client.sendall(b"GET /livez HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n")
                status = int(client.recv(4096)[9:12])
        except (OSError, ValueError):
            pass
        times.append((time.perf_counter() - start, status))
        ending.wait(pause)


class Probes:
    """/livez on both ports while something else goes on."""

    def __init__(self, service, expect):
        self.expect = expect
        self.ending, self.times, self.naps = threading.Event(), {"same": [], "admin": []}, []
        self.threads = [threading.Thread(target=probe_times, args=(port, self.ending, self.times[name]))
                        for name, port in (("same", service.port), ("admin", service.admin_port))]
        self.threads.append(threading.Thread(target=self.nap))
        for thread in self.threads:
            thread.start()

    def nap(self):
        """How late the machine lets anyone run: the measure of what a probe can be."""
        while not self.ending.is_set():
            start = time.perf_counter()
            time.sleep(0.02)
            self.naps.append(time.perf_counter() - start - 0.02)

    def end(self, what):
        self.ending.set()
        for thread in self.threads:
            thread.join()
        sentences = []
        for name, times in self.times.items():
            self.expect(all(status == 200 for _, status in times), f"{what}: /livez ({name} port) did not always answer 200")
            values = [seconds for seconds, _ in times]
            self.expect(percentile(values, 0.99) < 0.01, f"{what}: p99 of /livez ({name} port) is {percentile(values, 0.99) * 1000:.1f} ms")
            sentences.append(f"{name} port p50 {percentile(values, 0.5) * 1000:.1f} ms, p99 {percentile(values, 0.99) * 1000:.1f} ms of {len(values)}")
        return "/livez " + "; ".join(sentences) + f"; a sleep ends late by p50 {percentile(self.naps, 0.5) * 1000:.1f} ms, p99 {percentile(self.naps, 0.99) * 1000:.1f} ms"
