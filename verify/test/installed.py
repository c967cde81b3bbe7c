#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests an installation (`meson install`) as a user would.

  installed.py SOURCE BUILD WORK LIBDIR CC...    installs into a folder of WORK, then: the files are those that
                                                 should be there; the library exports what its headers document;
                                                 headers stand alone in C and C++; the examples of
                                                 verify/examples/library are built, run, and notice their typo;
                                                 the program finds its data wherever the tree is moved; manual
                                                 and completion know every option; uninstall leaves nothing
  installed.py SOURCE BUILD WORK LIBDIR --subproject    a project that has this one as a subproject

Exit status 77 (skipped): this build makes no library (sanitizers), or there is no pkg-config."""
import os
import re
import shutil
import subprocess
import sys

failures = []


def expect(is_so, what, *values):
    if not is_so:
        failures.append(what % values if values else what)


def run(*command, **how):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, stdin=subprocess.DEVNULL, **how)


def must(*command, **how):
    done = run(*command, **how)
    if done.returncode:
        sys.exit("%s: exit %d\n%s%s" % (" ".join(map(str, command)), done.returncode, done.stdout[-3000:], done.stderr[-3000:]))
    return done.stdout


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def files_below(folder):
    return sorted(os.path.relpath(os.path.join(at, name), folder) for at, _, names in os.walk(folder) for name in names)


def expected(source, libdir):
    """The expected files, from the lists in the source."""
    commands = re.findall(r"^COMMAND\((\w+)\)", read(os.path.join(source, "verify/command/commands.def")), re.M)
    headers = [name for name in os.listdir(os.path.join(source, "src/include/sphproof")) if name.endswith(".h")]
    cases = [name for name in os.listdir(os.path.join(source, "cases")) if name.endswith(".ini")]
    version = re.search(r"version: '([\d.]+)'", read(os.path.join(source, "meson.build")))[1]
    return commands, sorted(
        ["bin/sphproof", libdir + "/libsphproof.a", libdir + "/libsphproof.so", libdir + "/libsphproof.so." + version.split(".")[0],
         libdir + "/libsphproof.so." + version, libdir + "/pkgconfig/sphproof.pc",
         "share/bash-completion/completions/sphproof", "share/fish/vendor_completions.d/sphproof.fish",
         "share/zsh/site-functions/_sphproof", "share/man/man1/sphproof.1", "share/sphproof/sphproof-1.schema.json",
         "sphproof.py"]  # wherever this Python looks
        + ["share/man/man1/sphproof-%s.1" % name for name in commands]
        + ["include/sphproof/" + name for name in headers]
        + ["share/sphproof/cases/" + name for name in cases])


def check_symbols(include, library, archive):
    text = "".join(read(os.path.join(include, name)) for name in os.listdir(include) if name not in ("plugin.h", "reference.h"))
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
    promised = set(re.findall(r"\b(sphproof_\w+)\(", text)) - {
        name for name in re.findall(r"typedef[^;]*?\b(sphproof_\w+)\(", text)}
    for file, option in ((library, "-D"), (archive, "-g")):
        exported = {line.split()[-1].split("@")[0] for line in must("nm", option, "--defined-only", file).splitlines()
                    if re.search(r" [TDRBVW] ", line)}
        expect(exported == promised and len(promised) > 20, "%s: exported but not documented: %s; the other way: %s",
               os.path.basename(file), sorted(exported - promised), sorted(promised - exported))


def check_headers(include, work, cc):
    languages = [(cc, "c", "-std=c11")]
    if shutil.which("c++"):
        languages.append((["c++"], "c++", "-std=c++11"))
    for name in sorted(os.listdir(include)):
        for compiler, language, standard in languages:
            path = os.path.join(work, "alone.c")
            with open(path, "w", encoding="ascii") as file:
                file.write("#include <sphproof/%s>\n#include <sphproof/%s>\nint main(void) { return 0; }\n" % (name, name))
            done = run(*compiler, "-x", language, standard, "-Wall", "-Wextra", "-pedantic", "-Werror", "-fsyntax-only",
                       "-I", os.path.dirname(include), path)
            expect(done.returncode == 0, "%s does not stand alone in %s:\n%s", name, language, done.stderr)


def check_examples(source, stage, work, libdir, cc):
    folder, lib = os.path.join(source, "verify/examples/library"), os.path.join(stage, libdir)
    environment = dict(os.environ, PKG_CONFIG_PATH=os.path.join(lib, "pkgconfig") + os.pathsep + os.environ.get("PKG_CONFIG_PATH", ""),
                       LD_LIBRARY_PATH=lib)
    shared = must("pkg-config", "--cflags", "--libs", "sphproof", env=environment).split()
    static = must("pkg-config", "--cflags", "--static", "--libs", "sphproof", env=environment).split()
    static = [os.path.join(lib, "libsphproof.a") if word == "-lsphproof" else word for word in static]
    for name in ("certify_kernel", "check_gradient"):
        for how, words in (("shared", shared), ("static", static)):
            for typo in (0, 1):
                made = os.path.join(work, name)
                must(*cc, "-O1", "-Wall", "-Wextra", "-pedantic", "-Werror", *["-DTYPO"] * typo, os.path.join(folder, name + ".c"),
                     *words, "-lm", "-o", made)
                done = run(made, env=environment if how == "shared" else None)
                expect(done.returncode == typo and ("FAIL" in done.stdout) == bool(typo), "%s, %s%s: exit %d\n%s%s", name, how,
                       " with a typo" if typo else "", done.returncode, done.stdout, done.stderr)
    gate = os.path.join(work, "order_gate")
    must("meson", "setup", gate, os.path.join(folder, "order_gate"), env=environment)
    must("meson", "test", "-C", gate, env=environment)
    must("meson", "configure", gate, "-Dtypo=true", env=environment)
    done = run("meson", "test", "-C", gate, "--print-errorlogs", env=environment)
    expect(done.returncode == 1 and "is outside [1.9, 2.1]" in done.stdout + done.stderr,
           "order_gate: a typo is not noticed, or not as a wrong order:\n%s", done.stdout[-1500:])


def check_program(stage, work, commands):
    moved = os.path.join(work, "elsewhere", "moved")
    shutil.copytree(stage, moved, symlinks=True)
    program = os.path.join(moved, "bin/sphproof")
    where = must(program, "list", "--where", cwd="/").splitlines()
    expect(len(where) == 2 and all(moved in os.path.normpath(line.split()[1]) and os.path.exists(line.split()[1]) for line in where),
           "the moved program does not find its own data: %s", where)
    shutil.copy(os.path.join(moved, "share/sphproof/cases/sod.ini"), os.path.join(moved, "share/sphproof/cases/ours.ini"))
    done = run(program, "run", "ours", "n=100", cwd=work)
    expect(done.returncode == 0, "a case beside the installed ones is not found: %s", done.stderr)
    done = run(program, "run", "theirs", cwd=work)
    expect(done.returncode == 2, "a case that is nowhere: exit %d", done.returncode)
    fish = read(os.path.join(moved, "share/fish/vendor_completions.d/sphproof.fish"))
    zsh = read(os.path.join(moved, "share/zsh/site-functions/_sphproof"))
    for command in commands:
        options = set(re.findall(r"^  --(\w[\w-]*)", must(program, command, "--help"), re.M))
        page = read(os.path.join(moved, "share/man/man1/sphproof-%s.1" % command)).replace("\\-", "-")
        zsh_branch = re.search(r"^    %s\)\n(.*?;;)" % command, zsh, re.M | re.S)[1]
        for option in options:
            expect("--%s\\fR" % option in page, "sphproof-%s.1 has no --%s", command, option)
            expect("'--%s[" % option in zsh_branch, "_sphproof: no --%s of %s", option, command)
            expect(re.search(r"complete -c sphproof( -n '__fish_seen_subcommand_from %s')? -l %s " % (command, option), fish),
                   "sphproof.fish: no --%s of %s", option, command)
        expect(len(options) >= 6, "`sphproof %s --help` has only %s", command, options)
    for shell, file in (("bash", "bash-completion/completions/sphproof"), ("zsh", "zsh/site-functions/_sphproof"),
                        ("fish", "fish/vendor_completions.d/sphproof.fish")):
        if shutil.which(shell):
            must(shell, "-n", os.path.join(moved, "share", file))
    if shutil.which("bash"):
        for words, wanted in (("sphproof conv", {"converge"}), ("sphproof run so", {"sod", "sod_2d", "sod_3d", "sod_standard", "sound=", "sound_wave",
                               "sound_wave_2d", "sound_wave_3d"}), ("sphproof run sod kernel = cub", {"cubic_spline"}),
                              ("sphproof run sod --sn", {"--snapshot", "--snapshot-every"}), ("sphproof judge a --case gre", {"gresho"}),
                              ("sphproof list --color ne", {"never"})):
            script = ('. "$1"; COMP_WORDS=(%s); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _sphproof; printf "%%s\\n" "${COMPREPLY[@]}"' % words)
            got = set(must("bash", "-c", script, "bash", os.path.join(moved, "share/bash-completion/completions/sphproof"), cwd="/").split())
            expect(got == wanted, "completion of `%s`: %s", words, sorted(got))
    done = run("mandoc", "-T", "lint", "-W", "error", os.path.join(moved, "share/man/man1/sphproof.1")) if shutil.which("mandoc") else None
    expect(done is None or done.returncode == 0, "mandoc: %s", done and done.stdout)


def stage_of(build, work):
    """Installs below `work`; returns the folder that has bin and lib. The list of files that `ninja uninstall` reads
    is restored."""
    log = os.path.join(build, "meson-logs/install-log.txt")
    kept = read(log) if os.path.exists(log) else None
    try:
        must("meson", "install", "-C", build, "--no-rebuild", "--destdir", work)
        listed = [line for line in read(log).splitlines() if not line.startswith("#")]
    finally:
        if kept is not None:
            with open(log, "w", encoding="utf-8") as file:
                file.write(kept)
    return os.path.dirname(os.path.dirname(next(path for path in listed if path.endswith("/bin/sphproof")))), listed


def uninstalled(build, listed, destdir):
    """Removes files as `ninja uninstall` does, with the list of the installation."""
    log = os.path.join(build, "meson-logs/install-log.txt")
    kept = read(log)
    try:
        with open(log, "w", encoding="utf-8") as file:
            file.write("\n".join(listed) + "\n")
        must("meson", "--internal", "uninstall", cwd=build)
    finally:
        with open(log, "w", encoding="utf-8") as file:
            file.write(kept)
    expect(not files_below(destdir), "uninstall leaves %s", files_below(destdir))


def installed(source, build, work, libdir, *cc):
    destdir = os.path.join(work, "stage")
    stage, listed = stage_of(build, destdir)
    commands, wanted = expected(source, libdir)
    there = sorted("sphproof.py" if path.endswith("-packages/sphproof.py") else path for path in files_below(stage))
    expect(there == wanted, "installed but not expected: %s; the other way: %s",
           sorted(set(there) - set(wanted)), sorted(set(wanted) - set(there)))
    expect(len(files_below(destdir)) == len(there), "something is installed outside of the prefix")
    pc = os.path.join(stage, libdir, "pkgconfig/sphproof.pc")
    text = read(pc)
    with open(pc, "w", encoding="utf-8") as file:  # the staged folder is not the configured prefix
        file.write(re.sub(r"^prefix=.*", lambda _: "prefix=" + stage, text, flags=re.M))
    check_symbols(os.path.join(stage, "include/sphproof"), os.path.join(stage, libdir, "libsphproof.so"),
                  os.path.join(stage, libdir, "libsphproof.a"))
    check_headers(os.path.join(stage, "include/sphproof"), work, list(cc))
    check_examples(source, stage, work, libdir, list(cc))
    check_program(stage, work, commands)
    uninstalled(build, listed, destdir)


PARENT = {
    "meson.build": """project('parent', 'c')
sphproof = subproject('sphproof', default_options: ['slow=false', 'clones=false', 'optimization=0']).get_variable('sphproof_dep')
executable('parent', 'parent.c', dependencies: sphproof)
""",
    "parent.c": """#include <sphproof/kernels.h>
#include <sphproof/plugin.h>
#include <sphproof/reference.h>
#include <stdio.h>
int main(void)
{
    struct sphproof_kernel *kernel;
    if (sphproof_kernels_find("cubic_spline", &kernel, NULL)) return 1;
    printf("%.3f\\n", sphproof_kernels_value(kernel, 0, 1, 3));
    sphproof_kernels_free(kernel);
    return 0;
}
""",
}


def subproject(source, work):
    os.makedirs(os.path.join(work, "subprojects"))
    ignored = shutil.ignore_patterns("build*", ".git", "out")
    shutil.copytree(source, os.path.join(work, "subprojects/sphproof"), ignore=ignored)
    for name, text in PARENT.items():
        with open(os.path.join(work, name), "w", encoding="ascii") as file:
            file.write(text)
    must("meson", "setup", "build", cwd=work)
    must("ninja", "-C", "build", "parent", cwd=work)
    said = must(os.path.join(work, "build/parent"))
    expect(said.strip() == "2.546", "the parent says %s", said)


if __name__ == "__main__":
    if len(sys.argv) < 6:
        sys.exit(__doc__)
    source, build, work, libdir = sys.argv[1:5]
    shutil.rmtree(work, ignore_errors=True)
    os.makedirs(work)
    if not shutil.which("pkg-config") or not os.path.exists(os.path.join(build, "verify/package/libsphproof.a")):
        print("no pkg-config, or no library in this build")
        sys.exit(77)
    if sys.argv[5] == "--subproject":
        subproject(source, work)
    else:
        installed(source, build, work, libdir, *sys.argv[5:])
    print("\n".join(failures) or "what is installed is right")
    sys.exit(bool(failures))
