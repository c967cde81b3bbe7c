# SPDX-License-Identifier: GPL-3.0-or-later
"""A cluster of two nodes on this host with Slurm's own daemons: munged, slurmctld and two slurmd, in a folder of
their own, which end with it."""
import contextlib
import getpass
import os
import shutil
import signal
import socket
import subprocess
import time

TOOLS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel")


def tool(name):
    """Daemons are in sbin, which may not be in PATH."""
    return shutil.which(name) or shutil.which(name, path="/usr/sbin:/usr/local/sbin:/sbin")


def missing():
    """Slurm's tools that are not installed."""
    return [name for name in TOOLS if not tool(name)]


def free_ports(count):
    with contextlib.ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in range(count)]
        for one in sockets:
            one.bind(("127.0.0.1", 0))
        return [one.getsockname()[1] for one in sockets]


def processes():
    """Process number -> (command line, environment) of readable processes."""
    found = {}
    for pid in filter(str.isdigit, os.listdir("/proc")):
        with contextlib.suppress(OSError):
            with open("/proc/%s/cmdline" % pid, "rb") as line, open("/proc/%s/environ" % pid, "rb") as environ:
                found[int(pid)] = (line.read().split(b"\0"), environ.read().split(b"\0"))
    return found


def parent(pid):
    with open("/proc/%d/stat" % pid, encoding="ascii", errors="replace") as file:
        return int(file.read().rsplit(")", 1)[1].split()[1])


class Cluster:
    def __init__(self, folder, data):
        self.folder = folder
        self.conf = os.path.join(folder, "slurm.conf")
        self.daemons = {}
        self.ports = free_ports(3)
        with open(os.path.join(data, "slurm.conf"), encoding="ascii") as file:
            text = file.read()
        values = {"HOST": socket.gethostname().split(".")[0], "USER": getpass.getuser(), "DIR": folder,
                  "PORT0": self.ports[0], "PORT1": self.ports[1], "PORT2": self.ports[2]}
        for name, value in values.items():
            text = text.replace("@%s@" % name, str(value))
        os.makedirs(os.path.join(folder, "state"))
        os.makedirs(os.path.join(folder, "munge"), mode=0o755)
        with open(self.conf, "w", encoding="ascii") as file:
            file.write(text)
        os.environ["SLURM_CONF"] = self.conf
        key = os.path.join(folder, "munge", "key")
        with open(key, "wb") as file:
            os.chmod(key, 0o600)
            file.write(os.urandom(128))

    def start(self, name):
        munge = os.path.join(self.folder, "munge")
        words = {"munged": ["munged", "--foreground", "--force", "--num-threads=2"] +
                 ["--%s=%s" % (what, os.path.join(munge, file)) for what, file in
                  (("socket", "socket"), ("key-file", "key"), ("pid-file", "pid"), ("log-file", "log"),
                   ("seed-file", "seed"))],
                 "slurmctld": ["slurmctld", "-D", "-f", self.conf]}
        words = words.get(name) or ["slurmd", "-D", "-N", name, "-f", self.conf]
        words[0] = tool(words[0])
        with open(os.path.join(self.folder, name + ".said"), "ab") as said:
            self.daemons[name] = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=said, stderr=said,
                                                  start_new_session=True)

    def begin(self):
        for name in ("munged", "slurmctld", "n0", "n1"):
            self.start(name)
            if name == "munged":
                self.wait(lambda: os.path.exists(os.path.join(self.folder, "munge", "socket")), "munged")
        self.wait(lambda: self.states() == ["idle", "idle"], "two idle nodes")

    def states(self):
        done = subprocess.run(["sinfo", "-h", "-N", "-p", "main", "-o", "%t"], capture_output=True, text=True)
        return done.stdout.split()

    def wait(self, ready, what, limit=20):
        until = time.monotonic() + limit
        while not ready():
            if time.monotonic() > until:
                raise RuntimeError("no %s after %d s; see %s" % (what, limit, self.folder))
            time.sleep(0.05)

    def tasks(self, node=None):
        """Processes of running tasks (on a node): process number -> words."""
        wanted = b"SLURM_CONF=" + self.conf.encode()
        return {pid: words for pid, (words, environ) in processes().items()
                if wanted in environ and any(e.startswith(b"SLURM_ARRAY_TASK_ID=") for e in environ)
                and (node is None or b"SLURMD_NODENAME=" + node.encode() in environ)}

    def crash(self, node):
        """Simulates a power failure: kills slurmd, the processes that watch its tasks, and the tasks."""
        self.daemons[node].send_signal(signal.SIGKILL)
        self.daemons[node].wait()
        tasks = self.tasks(node)
        watchers = set()
        for pid in tasks:
            with contextlib.suppress(OSError):
                above = parent(pid)
                with open("/proc/%d/cmdline" % above, "rb") as line:
                    if line.read().startswith(b"slurmstepd"):
                        watchers.add(above)
        for pid in [*watchers, *tasks]:
            with contextlib.suppress(OSError):
                os.kill(pid, signal.SIGKILL)

    def end(self):
        for name in ("n0", "n1", "slurmctld", "munged"):
            daemon = self.daemons.get(name)
            if daemon and daemon.poll() is None:
                daemon.terminate()
        for pid in self.tasks():
            with contextlib.suppress(OSError):
                os.kill(pid, signal.SIGKILL)
        for daemon in self.daemons.values():
            with contextlib.suppress(subprocess.TimeoutExpired):
                daemon.wait(5)
            if daemon.poll() is None:
                daemon.kill()
                daemon.wait()
