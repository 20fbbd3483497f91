"""Attacks by the environment: clock, resources, closed outputs."""

import os
import pathlib
import shutil
import signal
import subprocess

import scene_hashes

from .outputs import command, good_results
from .scenes import INPUTS

CLOCK = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <sys/time.h>
#include <time.h>
static long calls;
/* The clock of the day is set back by an hour, and again, every twentieth time that it is read. */
static long back(void) { return 3600 * (++calls / 20); }
int clock_gettime(clockid_t which, struct timespec *out) {
    static int (*next)(clockid_t, struct timespec *);
    if (!next) next = dlsym(RTLD_NEXT, "clock_gettime");
    int failed = next(which, out);
    if (which == CLOCK_REALTIME || which == CLOCK_REALTIME_COARSE) out->tv_sec -= back();
    return failed;
}
time_t time(time_t *out) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    if (out) *out = now.tv_sec;
    return now.tv_sec;
}
int gettimeofday(struct timeval *out, void *zone) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    out->tv_sec = now.tv_sec;
    out->tv_usec = now.tv_nsec / 1000;
    return 0;
}
"""

SCENE = ("grains/box.toml", ["grains.0.count=100", "time.end=0.02", "output.frames=2", "output.checkpoint=0.01"])


def clock(bench, rng):
    """Clock set back, files from the future."""
    if not shutil.which("cc"):
        return
    source, library = bench.work / "clock.c", bench.work / "clock.so"
    source.write_text(CLOCK)
    subprocess.run(["cc", "-O1", "-shared", "-fPIC", "-o", library, source, "-ldl"], check=True)
    whole = good_results(bench, [SCENE])[SCENE[0]]
    files = scene_hashes.files(whole)
    for future in (False, True, False):
        out = bench.fresh()
        words = command(*SCENE, out)
        env = {"LD_PRELOAD": str(library)}
        bench.attempt(*words, out=out, codes={0}, env=env, soon=60)
        if scene_hashes.files(out) != files:
            bench.fault(words, "a run with a clock that is set back has other results")
        for path in out.rglob("*") if future else []:
            os.utime(path, (4e9, 4e9))
        bench.attempt(*words, out=out, untouched=[out], codes={2}, env=env)
        page = bench.work / "page.html"
        bench.attempt("report", out, "--out", page, "--force", untouched=[out], codes={0}, env=env)
        bench.attempt("view", out, "--export", page, "--force", untouched=[out], codes={0}, env=env)
        yield


def limits(bench, rng):
    """Limited memory, files and processes, full disks, closed outputs: a message and an exit code, no signal."""
    scene = INPUTS / "grains/box.toml"
    # Below the program's size the kernel kills it; slightly above, the loader fails.
    size = bench.program.stat().st_size // 1024
    limits_ = [f"-v {size + more}" for more in (5_000, 8_000, 20_000, 60_000, 110_000, 200_000)] + [f"-n {n}" for n in (4, 5, 6, 8, 16)]
    limits_ += ["-f 1", "-f 16", "-s 256", "-s 1024", "-t 1"]
    results = good_results(bench, [SCENE])[SCENE[0]]
    commands = [["check", scene], command(*SCENE, bench.work / "limited"), ["mesh", "info", INPUTS / "coupled/embankment_tet10/embankment.msh"]]
    commands += [["report", results, "--force", "--out", bench.work / "limited.html"]]
    commands += [["view", results, "--force", "--export", bench.work / "limited.html"]]
    commands += [["render", results, "--force", "--out", bench.work / "limited.png"]]
    commands += [["study", INPUTS / "studies/newton_settlement.toml", "--out", bench.work / "limited"]]
    for limit in limits_:
        # Accepted studies take minutes.
        for words in commands if limit.startswith("-n") else commands[:-1]:
            bench.fresh("limited")
            wrap = ["sh", "-c", f'ulimit {limit}; exec "$0" "$@"']
            # The kernel kills at the CPU time limit.
            at_limit = {-signal.SIGKILL, -signal.SIGXCPU} if "-t" in limit else set()
            codes = {0, 3, 127} if "-v" in limit else {1} if "-n" in limit else {0, 1, 2, 3, 130} | at_limit
            # Backtraces need memory.
            env = {"RAYON_NUM_THREADS": "2", "RUST_BACKTRACE": "1"}
            code, said = bench.attempt(*words, wrap=wrap, codes=codes, env=env)
            if "-v" in limit and code == 3 and "(ulimit -v" not in said or "-n" in limit and "(ulimit -n" not in said:
                bench.fault(words, f"{limit}: no remedy in {said!r}")
            yield
    for redirection in (">&-", "2>&-", "<&-", ">&- 2>&- <&-", ">/dev/full", "2>/dev/full"):
        wrap = ["sh", "-c", f'exec "$0" "$@" {redirection}']
        bench.attempt("check", scene, wrap=wrap, codes={0, 1})
        yield
    sealed = bench.fresh("sealed")
    sealed.mkdir()
    out = sealed / "file"
    pathlib.Path(out).write_text("kept")
    bench.attempt(*command(*SCENE, out), untouched=[out], codes={1, 2})
    bench.attempt(*command(*SCENE, "/dev/null"), codes={1, 2})
    bench.attempt(*command(*SCENE, "/proc/self/x"), codes={1, 2})
    yield
