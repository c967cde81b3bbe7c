# SPDX-License-Identifier: GPL-3.0-or-later
"""The conditions under which world.py runs the quick suite: how each is set up, and the sign by which a process sees
that it holds. A new condition is one entry of CONDITIONS."""
import datetime
import locale
import os
import resource
import shlex
import shutil
import socket
import struct
import subprocess
import sys
import tempfile
import time


class NotTried(Exception):
    """Why a condition cannot be set up here."""


class NotBuilt(Exception):
    """The tree does not build under a condition: that is a failure."""


class Place:
    """Paths of the tree, its build and the work folder, and the environment to start from."""

    def __init__(self, source, build, work, environment):
        self.source, self.build, self.work, self.environment = source, build, work, environment
        os.makedirs(work, exist_ok=True)


class World:
    """One condition, set up while the `with` lasts. Tests run as prefix + meson test, each of them behind wrapper,
    with this environment."""

    def __init__(self, condition, place):
        self.name, self.condition, self.place = condition.name, condition, place
        self.source, self.build = place.source, place.build
        self.logs = os.path.join(self.build, "meson-logs")
        self.prefix, self.wrapper, self.environment = [], [], dict(place.environment)
        self.endings = []

    def __enter__(self):
        self.folder = tempfile.mkdtemp(prefix="world-", dir=self.place.work)
        self.endings.append(lambda: shutil.rmtree(self.folder, ignore_errors=True))
        try:
            self.condition.set_up(self)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        while self.endings:
            self.endings.pop()()

    # ---- parts of conditions ----

    def variables(self, **values):
        """Environment variables; None: unset."""
        for name, value in values.items():
            if value is None:
                self.environment.pop(name, None)
            else:
                self.environment[name] = value

    def inside(self, *words):
        """Tests run inside this command. If it does not even start `true`, the condition is not tried."""
        self.prefix += words
        done = subprocess.run(self.prefix + ["true"], env=self.environment, capture_output=True, text=True,
                              errors="replace", check=False)
        if done.returncode:
            raise NotTried((done.stderr.strip() or " ".join(words[:2])).splitlines()[-1])

    def shell(self, line):
        """Tests run in a shell after this line."""
        self.inside("sh", "-c", line + ' && exec "$@"', "sh")

    def unshare(self, *words):
        """Tests run in namespaces of their own."""
        if not shutil.which("unshare"):
            raise NotTried("no unshare here (Debian: util-linux)")
        self.inside("unshare", *([] if os.geteuid() == 0 else ["--map-root-user"]), *words, "--")

    def copy(self, folder, *options):
        """The tree in another folder, built there."""
        self.source, self.build = folder, os.path.join(folder, "build")
        self.logs = os.path.join(self.build, "meson-logs")
        for command in (["meson", "setup", self.build, self.source, *options], ["ninja", "-C", self.build]):
            done = subprocess.run(command, env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                  text=True, errors="replace", check=False)
            if done.returncode:
                raise NotBuilt(done.stdout.strip()[-300:].replace("\n", " | "))

    def free_of(self, folder):
        """A mount over this folder must hide neither tree nor build."""
        for needed in self.place.source, self.place.build, self.place.work:
            if os.path.commonpath([needed, folder]) == folder:
                raise NotTried("%s is in %s" % (needed, folder))


# ---- clocks ----

def uptime(seconds):
    def set_up(world):
        now = {"monotonic": time.clock_gettime(time.CLOCK_MONOTONIC), "boottime": time.clock_gettime(time.CLOCK_BOOTTIME)}
        try:
            with open("/proc/self/timens_offsets", encoding="ascii") as file:
                offsets = {line.split()[0]: int(line.split()[1]) for line in file}
        except OSError:
            raise NotTried("this kernel has no time namespaces") from None
        words = [word for clock in now for word in ("--" + clock, str(int(offsets[clock] + seconds - now[clock])))]
        world.unshare("--time", *words)
    return set_up


def preload(world, code):
    """Programs start with these C functions in place of the library's."""
    source, library = os.path.join(world.folder, "preload.c"), os.path.join(world.folder, "preload.so")
    with open(source, "w", encoding="ascii") as file:
        file.write("#define _GNU_SOURCE\n#include <dlfcn.h>\n#include <sys/stat.h>\n#include <sys/time.h>\n#include <time.h>\n#include <unistd.h>\n"
                   + code)
    if not shutil.which("cc"):
        raise NotTried("no C compiler cc here")
    done = subprocess.run(["cc", "-shared", "-fPIC", "-o", library, source, "-ldl"], capture_output=True, text=True,
                          errors="replace", check=False)
    if done.returncode:
        raise NotTried("cc: " + (done.stderr.strip().splitlines() or ["fails"])[0])
    world.variables(LD_PRELOAD=library)


WALL_CLOCK = """
#define REAL(type, name, ...) ((type(*)(__VA_ARGS__))dlsym(RTLD_NEXT, name))
int clock_gettime(clockid_t clock, struct timespec *t)
{
    const int code = REAL(int, "clock_gettime", clockid_t, struct timespec *)(clock, t);
    if (!code && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE)) t->tv_sec += ahead();
    return code;
}
int gettimeofday(struct timeval *restrict t, void *restrict zone)
{
    struct timespec now;
    (void)zone;
    clock_gettime(CLOCK_REALTIME, &now);
    t->tv_sec = now.tv_sec, t->tv_usec = now.tv_nsec / 1000;
    return 0;
}
time_t time(time_t *t)
{
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    if (t) *t = now.tv_sec;
    return now.tv_sec;
}
"""

# File times follow the clock: they are later by the shift when read, and earlier when set.
FILE_TIMES = """
static int later(int code, struct stat *s)
{
    if (!code) s->st_mtim.tv_sec += ahead(), s->st_atim.tv_sec += ahead(), s->st_ctim.tv_sec += ahead();
    return code;
}
#define STATS(end) \\
    int stat##end(const char *restrict p, struct stat##end *restrict s) \\
    { return later(REAL(int, "stat", const char *, void *)(p, s), (struct stat *)s); } \\
    int lstat##end(const char *restrict p, struct stat##end *restrict s) \\
    { return later(REAL(int, "lstat", const char *, void *)(p, s), (struct stat *)s); } \\
    int fstat##end(int f, struct stat##end *s) \\
    { return later(REAL(int, "fstat", int, void *)(f, s), (struct stat *)s); } \\
    int fstatat##end(int f, const char *restrict p, struct stat##end *restrict s, int how) \\
    { return later(REAL(int, "fstatat", int, const char *, void *, int)(f, p, s, how), (struct stat *)s); }
STATS()
STATS(64)
static const struct timespec *earlier(const struct timespec t[2], struct timespec changed[2])
{
    for (int i = 0; t && i < 2; i++) {
        changed[i] = t[i];
        if (t[i].tv_nsec < 1000000000) changed[i].tv_sec -= ahead(); /* else it says: now, or as it was */
    }
    return t ? changed : t;
}
int utimensat(int f, const char *p, const struct timespec t[2], int how)
{
    struct timespec c[2];
    return REAL(int, "utimensat", int, const char *, const struct timespec *, int)(f, p, earlier(t, c), how);
}
int futimens(int f, const struct timespec t[2])
{
    struct timespec c[2];
    return REAL(int, "futimens", int, const struct timespec *)(f, earlier(t, c));
}
"""


def date(*when):
    """The wall clock starts at this date, in UTC."""
    def set_up(world):
        if struct.calcsize("P") != 8:
            raise NotTried("only on systems of 64 bits")
        begin = datetime.datetime(*when, tzinfo=datetime.timezone.utc).timestamp()
        preload(world, "static time_t ahead(void) { return %d; }" % (begin - time.time()) + WALL_CLOCK + FILE_TIMES)
    return set_up


def jumping(world):
    """Four times a second the wall clock jumps five minutes forwards or back; the monotonic one does not."""
    preload(world, """
static time_t ahead(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (t.tv_nsec / 250000000) % 2 ? 300 : 0;
}""" + WALL_CLOCK)


def jumps(_):
    ahead = []
    for _ in range(10):
        ahead.append(time.time() - time.monotonic())
        time.sleep(0.07)
    return max(ahead) - min(ahead) > 60


def today():
    return datetime.datetime.now(datetime.timezone.utc)


# ---- languages ----

def language(name, charset="UTF-8"):
    def set_up(world):
        places = os.path.join(world.folder, "locales")
        os.mkdir(places)
        if not shutil.which("localedef"):
            raise NotTried("no localedef here (Debian: libc-bin)")
        done = subprocess.run(["localedef", "-i", name, "-f", charset, os.path.join(places, name + "." + charset)],
                              capture_output=True, text=True, errors="replace", check=False)
        if done.returncode:
            raise NotTried("localedef cannot make %s (Debian: locales)" % name)
        world.variables(LC_ALL=name + "." + charset, LANG=name + "." + charset, LOCPATH=places)
    return set_up


def speaks(start, decimal_point, charset):
    def sign(_):
        try:
            name = locale.setlocale(locale.LC_ALL, "")
        except locale.Error:
            return False
        return (name.startswith(start) and locale.localeconv()["decimal_point"] == decimal_point and
                locale.nl_langinfo(locale.CODESET) == charset)
    return sign


# ---- folders ----

def can_write(folder, size=1):
    try:
        with tempfile.NamedTemporaryFile(dir=folder) as file:
            file.write(size * b"x")
        return True
    except OSError:
        return False


def home(world):
    """A home whose files would change the behaviour of gnuplot and git."""
    folder = os.path.join(world.folder, "home")
    os.mkdir(folder)
    for name, text in ((".gnuplot", "set decimalsign ','\nset terminal dumb\nexit\n"),
                       (".gitconfig", "[commit]\n\tgpgsign = true\n[color]\n\tui = always\n[init]\n\tdefaultBranch = a/b\n"
                                      "[core]\n\tautocrlf = true\n[diff]\n\tnoprefix = true\n[status]\n\tshort = true\n")):
        with open(os.path.join(folder, name), "w", encoding="ascii") as file:
            file.write(text)
    world.variables(HOME=folder, XDG_CONFIG_HOME=None, XDG_CACHE_HOME=None)


def home_read_only(world):
    folder = os.path.join(world.folder, "home")
    os.mkdir(folder)
    world.variables(HOME=folder, XDG_CONFIG_HOME=None, XDG_CACHE_HOME=None)
    world.unshare("--mount")
    world.shell("mount -t tmpfs -o ro none %s" % shlex.quote(folder))


def temporary_elsewhere(world):
    folder = os.path.join(world.folder, "tmp ö 'q'")
    os.mkdir(folder)
    world.variables(TMPDIR=folder)


def temporary_file_system(world):
    world.free_of("/tmp")
    world.unshare("--mount")
    world.shell("mount -t tmpfs -o mode=1777 none /tmp")


def temporary_full(world):
    """/tmp itself, for tests that put their files elsewhere."""
    world.free_of("/tmp")
    folder = os.path.join(world.folder, "tmp")
    os.mkdir(folder)
    world.variables(TMPDIR=folder)
    world.unshare("--mount")
    world.shell("mount -t tmpfs -o size=16k none /tmp && { head -c 100000 /dev/zero >/tmp/full 2>/dev/null || :; }")


# ---- trees ----

def tree_files(source):
    done = subprocess.run(["git", "-C", source, "ls-files", "-z"], capture_output=True, check=False)
    if done.returncode == 0:
        return [os.fsdecode(name) for name in done.stdout.split(b"\0") if name]
    found = []
    for folder, folders, names in os.walk(source):
        folders[:] = [name for name in folders if not name.startswith("build")]
        found += [os.path.relpath(os.path.join(folder, name), source) for name in names]
    return found


def copy_files(source, folder):
    for name in tree_files(source):
        os.makedirs(os.path.dirname(os.path.join(folder, name)), exist_ok=True)
        if os.path.exists(os.path.join(source, name)):
            shutil.copy2(os.path.join(source, name), os.path.join(folder, name))


def tarball(world):
    folder = os.path.join(world.folder, "sphproof-0")
    os.mkdir(folder)
    copy_files(world.place.source, folder)
    world.variables(GIT_CEILING_DIRECTORIES=world.folder)
    world.copy(folder)


def strange_path(world):
    folder = os.path.join(world.folder, "Die schöne Größe & 'mehr'")
    os.mkdir(folder)
    copy_files(world.place.source, folder)
    world.copy(folder)


def shallow(world):
    folder = os.path.join(world.folder, "clone")
    done = subprocess.run(["git", "clone", "-q", "--depth", "1", "file://" + world.place.source, folder],
                          capture_output=True, text=True, check=False)
    if done.returncode:
        raise NotTried(done.stderr.strip().splitlines()[-1])
    world.copy(folder)


def is_shallow(source):
    done = subprocess.run(["git", "-C", source, "rev-parse", "--is-shallow-repository"], capture_output=True, text=True,
                          check=False)
    return done.stdout.strip() == "true"


# ---- machine ----

def not_root(world):
    """A user who owns a copy of the build, mounted where the build is, and nothing else."""
    if os.geteuid():
        raise NotTried("the whole test runs without root's rights already")
    nobody = 65534
    copy, home_name = os.path.join(world.folder, "build"), "home-of-nobody"
    os.chmod(world.folder, 0o755)

    def leave_out(folder, names):
        """The work folder, which the build may contain, and this copy in it."""
        return [name for name in names if os.path.join(folder, name) == world.place.work]

    shutil.copytree(world.place.build, copy, symlinks=True, ignore=leave_out)
    os.mkdir(os.path.join(copy, home_name))
    subprocess.run(["chown", "-R", "%d:%d" % (nobody, nobody), copy], check=True)
    subprocess.run(["chmod", "-R", "u+rwX", copy], check=True)
    world.variables(HOME=os.path.join(world.place.build, home_name), XDG_CACHE_HOME=None, XDG_CONFIG_HOME=None,
                    USER="nobody", LOGNAME="nobody",
                    PATH="/usr/local/bin:/usr/bin:/bin")
    world.unshare("--mount")
    world.shell("mount --bind %s %s" % (shlex.quote(copy), shlex.quote(world.place.build)))
    world.inside("setpriv", "--reuid", str(nobody), "--regid", str(nobody), "--clear-groups", "--inh-caps=-all", "--")
    world.logs = os.path.join(copy, "meson-logs")


def one_core(world):
    world.inside("taskset", "-c", str(min(os.sched_getaffinity(0))))


def many_cores(world):
    """Programs see 64 cores; as many tests run at once as usual."""
    preload(world, """
long sysconf(int name)
{
    long (*real)(int) = (long (*)(int))dlsym(RTLD_NEXT, "sysconf");
    return name == _SC_NPROCESSORS_ONLN || name == _SC_NPROCESSORS_CONF ? 64 : real(name);
}
""")
    world.variables(MESON_TESTTHREADS=str(os.cpu_count()))


class Condition:
    """implies: other conditions whose sign is also seen under this one."""

    def __init__(self, name, set_up, sign, implies=()):
        self.name, self.set_up, self.sign, self.implies = name, set_up, sign, list(implies)


def variables(**values):
    return lambda world: world.variables(**values)


def has(**values):
    return lambda _: all(os.environ.get(name) == value for name, value in values.items())


CONDITIONS = [
    Condition("as it is", lambda world: None, None),
    Condition("uptime 100 s", uptime(100), lambda _: time.clock_gettime(time.CLOCK_MONOTONIC) < 1000),
    Condition("uptime 10 years", uptime(10 * 365 * 86400), lambda _: time.monotonic() > 3e8),
    Condition("time zone UTC+14", variables(TZ="<+14>-14"), lambda _: time.localtime().tm_gmtoff == 14 * 3600),
    Condition("time zone UTC-3.30", variables(TZ="<-0330>3:30"), lambda _: time.localtime().tm_gmtoff == -12600),
    Condition("leap day", date(2028, 2, 29, 12), lambda _: (today().month, today().day) == (2, 29)),
    Condition("year boundary", date(2027, 12, 31, 23, 59, 50),
              lambda _: (today().year, today().month) in ((2027, 12), (2028, 1))),
    Condition("year 2038", date(2038, 1, 19, 3, 14, 0), lambda _: time.time() > 2**31 - 60),
    Condition("clock jumps", jumping, jumps),
    Condition("locale de_DE.UTF-8", language("de_DE"), speaks("de_DE", ",", "UTF-8")),
    Condition("locale tr_TR.UTF-8", language("tr_TR"), speaks("tr_TR", ",", "UTF-8")),
    Condition("locale de_DE.ISO-8859-1", language("de_DE", "ISO-8859-1"), speaks("de_DE", ",", "ISO-8859-1")),
    Condition("locale C", variables(LC_ALL="C", LANG=None, LANGUAGE=None), has(LC_ALL="C")),
    Condition("HOME unset", variables(HOME=None, XDG_CACHE_HOME=None, XDG_CONFIG_HOME=None), has(HOME=None)),
    Condition("HOME read-only", home_read_only, lambda _: "HOME" in os.environ and not can_write(os.environ["HOME"])),
    Condition("HOME with own settings", home,
              lambda _: os.path.exists(os.path.join(os.environ.get("HOME", "/nowhere"), ".gnuplot"))),
    Condition("XDG variables relative", variables(XDG_CACHE_HOME="cache", XDG_CONFIG_HOME="config"),
              has(XDG_CACHE_HOME="cache")),
    Condition("XDG variables nowhere", variables(XDG_CACHE_HOME="/proc/nowhere", XDG_CONFIG_HOME="/proc/nowhere"),
              has(XDG_CACHE_HOME="/proc/nowhere")),
    Condition("TERM unset", variables(TERM=None), has(TERM=None)),
    Condition("TERM dumb", variables(TERM="dumb"), has(TERM="dumb")),
    Condition("umask 077", lambda world: world.shell("umask 077"), lambda _: os.umask(0) == 0o77),
    Condition("CI=true", variables(CI="true", GITHUB_ACTIONS="true", GITLAB_CI="true"), has(CI="true")),
    Condition("POSIXLY_CORRECT", variables(POSIXLY_CORRECT="1", CDPATH="/:/usr"), has(POSIXLY_CORRECT="1")),
    Condition("PYTHONOPTIMIZE=1", variables(PYTHONOPTIMIZE="1"), lambda _: not __debug__),
    Condition("stdin closed", lambda world: world.wrapper.extend(["sh", "-c", 'exec "$@" <&-', "sh"]),
              lambda _: sys.stdin is None),
    Condition("TMPDIR elsewhere", temporary_elsewhere, lambda _: "ö" in tempfile.gettempdir()),
    Condition("/tmp another file system", temporary_file_system,
              lambda source: os.stat("/tmp").st_dev != os.stat(source).st_dev),
    Condition("/tmp full, TMPDIR elsewhere", temporary_full, lambda _: not can_write("/tmp", 65536),
              implies=["/tmp another file system"]),
    Condition("no network", lambda world: world.unshare("--net"), lambda _: len(socket.if_nameindex()) < 2),
    Condition("one core", one_core, lambda _: len(os.sched_getaffinity(0)) == 1),
    Condition("64 threads asked for", variables(OMP_NUM_THREADS="64"), has(OMP_NUM_THREADS="64")),
    Condition("64 cores claimed", many_cores, lambda _: os.cpu_count() == 64),
    Condition("ulimit -n 64", lambda world: world.shell("ulimit -n 64"),
              lambda _: resource.getrlimit(resource.RLIMIT_NOFILE)[0] == 64),
    Condition("not root", not_root, lambda _: os.geteuid() != 0 and can_write(os.environ["HOME"])),
    Condition("blanks and umlauts in paths", strange_path, lambda source: "schöne Größe" in source,
              implies=["tarball without .git"]),
    Condition("tarball without .git", tarball, lambda source: not os.path.exists(os.path.join(source, ".git"))),
    Condition("shallow clone", shallow, is_shallow),
]


def all_at_once(world):
    """Conditions that can hold together: for a first look, and for those that only matter together."""
    for name in ("time zone UTC-3.30", "locale de_DE.ISO-8859-1", "HOME read-only", "XDG variables relative", "TERM unset",
                 "umask 077", "CI=true", "POSIXLY_CORRECT", "PYTHONOPTIMIZE=1", "stdin closed", "TMPDIR elsewhere", "no network",
                 "one core", "64 threads asked for", "ulimit -n 64", "uptime 100 s"):
        named(name).set_up(world)


CONDITIONS.insert(1, Condition(
    "many at once", all_at_once,
    lambda source: all(named(name).sign(source) for name in ("umask 077", "HOME read-only", "stdin closed", "no network")),
    implies=[c.name for c in CONDITIONS]))


def named(name):
    return next(condition for condition in CONDITIONS if condition.name == name)


def chosen(words):
    """The conditions with these names or parts of names, separated by commas; always with the condition "as things
    are" first."""
    wanted = [word for word in words.split(",") if word]
    for word in wanted:
        if not any(word in condition.name for condition in CONDITIONS):
            sys.exit("world.py: no condition is called '%s'" % word)
    return [c for c in CONDITIONS[:1]] + [c for c in CONDITIONS[1:] if not wanted or any(w in c.name for w in wanted)]
