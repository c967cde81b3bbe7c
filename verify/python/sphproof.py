# SPDX-License-Identifier: GPL-3.0-or-later
"""sphproof in Python: runs, verdicts on snapshots, rates and exact solutions as numpy arrays.

    import sphproof
    sod = sphproof.run("sod", n=400, gradient="ia")
    sod["errors"]["density"]["l1"], sod["particles"]["rho"]
    exact = sphproof.riemann((1, 0, 1), (0.125, 0, 0.1), sod["particles"]["x"], t=0.2)
    sphproof.judge({"x": x, "vx": v, "m": m, "rho": rho, "u": u}, case="sod", time=0.2)["verdict"]
    sphproof.rates(x, v, m, u, lo=0, hi=1, kernel="wendland_c4")["force"]

Nothing is compiled: `run`, `judge` and `rates` call the program and read its JSON (what a document holds: see the
schema, `sphproof list --where`); exact solutions come from libsphproof through ctypes. The program is what SPHPROOF
names, else where this file was installed with it, else in a build folder `build` of the tree that this file is in, else
on the PATH (as after `pip install verify/python`). The library is what SPHPROOF_LIBRARY names, else that of the
program's own installation or build folder, else where the system looks. Units: any consistent ones. What fails raises
sphproof.Error."""
import collections
import ctypes
import ctypes.util
import glob
import json
import os
import shutil
import subprocess
import tempfile

import numpy

__all__ = ["Error", "State", "run", "judge", "rates", "command", "riemann", "star", "sedov", "noh", "gresho", "yee", "wave"]

State = collections.namedtuple("State", "rho v P")  # arrays with the shape of the positions


class Error(Exception):
    """Bad input (status 2), a simulation that broke down (3), no memory, no program (4). document: what a
    broken-down run had to say, else None."""

    def __init__(self, message, status=4, document=None):
        super().__init__(message)
        self.status, self.document = status, document


# ---- the program ----

def _beside(*patterns):
    """The first file that one of the patterns names, from a folder above this file."""
    folder = os.path.dirname(os.path.abspath(__file__))
    while folder != os.path.dirname(folder):
        folder = os.path.dirname(folder)
        for pattern in patterns:
            for path in sorted(glob.glob(os.path.join(glob.escape(folder), pattern))):
                return path
    return None


def _built():
    """The program in folder `build` of the source tree, if this module is in one."""
    tree, place = os.path.abspath(__file__).rsplit(os.sep, 3)[0], os.path.join("verify", "python", "sphproof.py")
    path = os.path.join(tree, "build", "sphproof")
    return path if os.path.abspath(__file__) == os.path.join(tree, place) and os.path.exists(path) else None


def _program():
    path = os.environ.get("SPHPROOF") or _beside("bin/sphproof") or _built() or shutil.which("sphproof")
    if not path:
        raise Error("no program sphproof: neither installed with this module, nor on the PATH, nor named by SPHPROOF")
    return path


def _number(value):
    """Results write numbers that are not finite as strings."""
    if isinstance(value, dict):
        return {key: _number(one) for key, one in value.items()}
    if isinstance(value, list):
        return [_number(one) for one in value]
    return float(value) if value in ("nan", "inf", "-inf") else value


def _word(value, key=None):
    if isinstance(value, (bool, numpy.bool_)):
        return ("no", "yes")[value] if key != "balsara" else ("off", "on")[value]
    return " ".join(one if isinstance(one, str) else repr(one) for one in numpy.ravel(value).tolist())


def command(name, *arguments, **keys):
    """The document of `sphproof NAME ARGUMENTS... KEY=VALUE...`; its exit status (0, or 1 where a check or gate
    failed) is under "exit_status"."""
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "result.json")
        words = [str(word) for word in arguments] + ["%s=%s" % (key, _word(value, key)) for key, value in keys.items()]
        done = subprocess.run([_program(), name] + words + ["--quiet", "--json", out], stdin=subprocess.DEVNULL,
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
        document = None
        if os.path.exists(out) and os.path.getsize(out):
            with open(out, encoding="utf-8") as file:
                document = _number(json.load(file))
    if done.returncode not in (0, 1) or document is None:
        said = done.stderr.strip().splitlines()
        raise Error(said[-1] if said else "sphproof %s: exit %d" % (name, done.returncode), done.returncode, document)
    document["exit_status"] = done.returncode
    return document


def _write_csv(path, columns):
    columns = {name: numpy.asarray(values, dtype=float).ravel() for name, values in columns.items()}
    if len({values.size for values in columns.values()}) != 1:
        raise Error("columns differ in length: %s" % {name: values.size for name, values in columns.items()}, 2)
    with open(path, "w", encoding="ascii") as file:
        file.write(",".join(columns) + "\n")
        for row in zip(*(values.tolist() for values in columns.values())):
            file.write(",".join(map(repr, row)) + "\n")


def _read_csv(path):
    with open(path, encoding="ascii") as file:
        names = file.readline().strip().split(",")
        values = numpy.loadtxt(file, delimiter=",", ndmin=2)
    return dict(zip(names, values.T))


def run(case, *, threads=1, **keys):
    """`sphproof run CASE KEY=VALUE...`: its document, with the particles at the end as arrays under
    "particles" (x, vx, m, rho, u, P, h ...)."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "snapshot.csv")
        document = command("run", case, "--snapshot", path, "--threads", threads, **keys)
        document["particles"] = _read_csv(path)
    return document


def judge(*snapshots, **options):
    """`sphproof judge SNAPSHOT... --OPTION VALUE...`: the document. A snapshot is the path of a file, or a dict of
    arrays: x[, y, z], vx[, vy, vz], m, rho, u, P, h as far as known. Options: case="sod", time=0.2, gamma=1.4,
    left=(1, 0, 1), right=(0.125, 0, 0.1), kernel="cubic_spline", gate="density_l1=2e-3" ...; underscores
    stand for dashes (h_is="sigma"); True gives an option that has no value (allow_far=True), False or None none."""
    with tempfile.TemporaryDirectory() as folder:
        words = []
        for number, snapshot in enumerate(snapshots):
            if isinstance(snapshot, dict):
                path = os.path.join(folder, "snapshot_%d.csv" % number)
                _write_csv(path, snapshot)
                snapshot = path
            words.append(snapshot)
        for name, value in options.items():
            if value is None or value is False:
                continue
            words += ["--" + name.replace("_", "-")] + ([] if value is True else [_word(value)])
        return command("judge", *words)


def rates(x, v, m, u, **keys):
    """One evaluation (`sphproof rates`) of n particles: x and v of shape (n,) or (n, dim), m and u of shape (n,).
    Keys: lo, hi, boundary, gamma and those of the scheme. Arrays h, rho, P, dU (n), force (n, dim) = dp/dt,
    neighbours (n), in the order given; the document itself is under "document"."""
    x, v = (numpy.asarray(a, dtype=float) for a in (x, v))
    x, v = (a.reshape(len(a), -1) for a in (x, v))
    dim = x.shape[1]
    if v.shape[1] != dim:
        raise Error("x and v differ in shape: %s, %s" % (x.shape, v.shape), 2)
    columns = {name: x[:, a] for a, name in enumerate("xyz"[:dim])}
    columns.update({"v" + name: v[:, a] for a, name in enumerate("xyz"[:dim])})
    columns.update(m=numpy.broadcast_to(m, len(x)), u=numpy.broadcast_to(u, len(x)))
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "particles.csv")
        _write_csv(path, columns)
        document = command("rates", path, **keys)
    result = {name: numpy.array([particle[name] for particle in document["particles"]])
              for name in ("h", "rho", "P", "force", "dU", "neighbours")}
    result["document"] = document
    return result


# ---- exact solutions ----

class _LibraryError(ctypes.Structure):
    _fields_ = [("status", ctypes.c_int), ("message", ctypes.c_char * 512)]


class _Star(ctypes.Structure):
    _fields_ = [(name, ctypes.c_double) for name in ("P", "v", "rho_left", "rho_right")] + [("speed", ctypes.c_double * 5)]


_loaded = None


def _of_program():
    """The library of the program's installation, or of its build folder; None where there is none."""
    try:
        folder = os.path.dirname(os.path.realpath(_program()))
    except Error:
        return None
    for pattern in ("verify/package/libsphproof.so.0", "../lib/libsphproof.so.0", "../lib*/libsphproof.so.0", "../lib/*/libsphproof.so.0"):
        for path in sorted(glob.glob(os.path.join(glob.escape(folder), pattern))):
            return os.path.normpath(path)
    return None


def _library():
    global _loaded
    if _loaded is None:
        path = os.environ.get("SPHPROOF_LIBRARY") or _of_program() or ctypes.util.find_library("sphproof")
        if not path:
            raise Error("no library libsphproof: neither beside the program, nor known to the system, nor named by SPHPROOF_LIBRARY")
        _loaded = ctypes.CDLL(path)
    return _loaded


def _call(name, *arguments):
    error = _LibraryError()
    status = getattr(_library(), "sphproof_solutions_" + name)(*arguments, ctypes.byref(error))
    if status:
        raise Error(error.message.decode(), status)


_real = ctypes.c_double
_pointer = ctypes.POINTER(ctypes.c_double)


def _at(array):
    return array.ctypes.data_as(_pointer)


def _states(*states):
    states = [numpy.array(state, dtype=float) for state in states]
    for state in states:
        if state.shape != (3,):
            raise Error("a state is density, velocity, pressure: %r" % (state.tolist(),), 2)
    return states


def _sample(name, parameters, places, *more):
    places = numpy.asarray(places, dtype=float)
    flat = numpy.ascontiguousarray(places.ravel())
    state = [numpy.empty_like(flat) for _ in range(3)]
    _call(name, *parameters, ctypes.c_size_t(flat.size), _at(flat), *map(_at, state), *more)
    return State(*(values.reshape(places.shape) for values in state))


def riemann(left, right, x, t, gamma=1.4, x0=0.0):
    """The Riemann problem left | right, each (rho, v, P), with its diaphragm at x0, at places x and time t."""
    left, right = _states(left, right)
    return _sample("riemann", (_real(gamma), _at(left), _at(right), _real(x0), _real(t)), x)


def star(left, right, gamma=1.4):
    """What is between the waves: {"P", "v", "rho_left", "rho_right", "speed": (left head, left tail, contact,
    right tail, right head)}; NaN where there is none."""
    left, right = _states(left, right)
    result = _Star()
    _call("star", _real(gamma), _at(left), _at(right), ctypes.byref(result))
    return {"P": result.P, "v": result.v, "rho_left": result.rho_left, "rho_right": result.rho_right, "speed": tuple(result.speed)}


def sedov(r, t, dim=3, gamma=1.4, rho=1.0, E=1.0):
    """Sedov's blast at distances r; v: outwards."""
    return _sample("sedov", (_real(gamma), ctypes.c_int(dim), _real(rho), _real(E), _real(t)), r, None)


def noh(r, t, dim=3, gamma=5 / 3):
    """Noh's implosion at distances r; v: outwards."""
    return _sample("noh", (_real(gamma), ctypes.c_int(dim), _real(t)), r)


def gresho(r):
    """Gresho's vortex at distances r; v: along the circle."""
    return _sample("gresho", (), r)


def yee(r, beta=5.0, gamma=1.4):
    """The isentropic vortex of strength beta at distances r; v: along the circle."""
    return _sample("yee", (_real(gamma), _real(beta)), r)


def wave(x, t, gamma=1.4, rho0=1.0, v0=0.0, P0=1.0, amplitude=1e-3, length=1.0):
    """An isentropic simple wave that runs to the right."""
    return _sample("wave", tuple(map(_real, (gamma, rho0, v0, P0, amplitude, length, t))), x)
