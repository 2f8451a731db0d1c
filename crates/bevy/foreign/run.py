#!/usr/bin/env python3
"""Runs examples of the published `bevy` crate with the plugin on every Camera3d, and compares them with full rate.

    foreign/run.py --assets BEVY/assets [--modes quads,gaze,antialias,again,own] [--out out/foreign] [EXAMPLE ...]
    foreign/run.py --assets BEVY/assets --modes auto [--fps 240] [--size 320x180] [--frames 40] [--rounds 2] ...

Takes the examples out of cargo's registry, patches copies of them, and runs each under a virtual display (Xvfb).
Writes pictures, logs and a table to the folder `out`. Nothing of Bevy's is committed: its assets, which the published
crate lacks, are a checkout of Bevy of the same version, or its git directory.

The mode `auto` writes no pictures: it measures TAA at full rate, antialiased quads, and `Foveated::auto` in turn.

Needs Python 3.9, Xvfb, a Vulkan driver, software or not, and cargo.
"""

import argparse
import functools
import glob
import json
import os
import re
import shutil
import signal
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
PLUGIN = HERE.parent
VERSION = "0.20.1"

EXAMPLES = (
    "3d_scene animated_mesh lighting transparency_3d skybox fog bloom_3d ssao parallax_mapping spotlight "
    "shader_prepass specialized_mesh_pipeline custom_phase_item first_person_view_model split_screen motion_blur "
    "deferred_rendering mirror many_foxes 3d_gizmos"
).split()

# A thousand foxes take minutes on a software driver. Unless in step, they start by the number of their entity, which
# differs with the plugin.
ARGUMENTS = {"many_foxes": ["--count", "100", "--sync"]}

# What each mode is compared with: the same antialiasing at full rate. `again` shows how alike two runs are; `own` is
# the example as it is, with its MSAA.
REFERENCES = {"quads": "full", "gaze": "full", "again": "full", "own": "full", "antialias": "taa"}

# Without MSAA, Bevy's upper camera clears what the lower one has drawn: quads are compared with the example as it is.
NEED_MSAA = {"first_person_view_model"}

# Large files, of which a copy of the repository may lack one, and what stands in for it.
STAND_INS = {
    "environment_maps/pisa_specular_rgb9e5_zstd.ktx2": "environment_maps/pisa_diffuse_rgb9e5_zstd.ktx2",
}

# What `Foveated::auto` is compared with: the faster of these.
AUTO_OVER = ("taa", "antialias")

TIMEOUT_S = 600

# Lines of the log that differ from run to run.
UNTOLD = ("Screenshot saved", "bevy_diagnostic", "Creating new window", "AdapterInfo")
LOG_LINE = re.compile(r"^\S+Z +(INFO|WARN|ERROR) (?:\S+: )*?([\w:]+): (.*)$")
ASSET = re.compile(r'"([\w./-]+\.(?:png|jpg|ktx2|glb|gltf|wesl|wgsl|hdr|ttf))')


def main():
    arguments = parse()
    out = arguments.out.resolve()
    package = out / "package"
    examples = {name: find_example(name) for name in arguments.examples or EXAMPLES}
    problems = write_package(package, examples)
    problems |= build(package, [name for name in examples if name not in problems])
    rows = earlier(out)
    for name, path in examples.items():
        folder = out / name
        shutil.rmtree(folder, ignore_errors=True)
        notes = [problems[name]] if name in problems else copy_assets(path, arguments.assets, out)
        if arguments.modes == ["auto"]:
            new = [] if name in problems else [time_auto(name, folder, arguments, notes)]
        else:
            new = run_example(name, folder, arguments, notes, name in problems)
        rows = [row for row in rows if row["example"] != name] + new
        # After each one, because all of them take long.
        write_report(out, rows)
    print((out / "table.md").read_text())


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("examples", nargs="*", metavar="EXAMPLE")
    parser.add_argument("--assets", type=Path, required=True)
    parser.add_argument("--modes", type=lambda text: text.split(","), default=["quads"])
    parser.add_argument("--out", type=Path, default=PLUGIN / "out/foreign")
    parser.add_argument("--fps", type=float, default=240, help="target of `Foveated::auto`")
    parser.add_argument("--size", default="320x180", help="of the window, in mode auto")
    parser.add_argument("--frames", type=int, default=40, help="that are measured, in mode auto")
    parser.add_argument("--rounds", type=int, default=2, help="of which the fastest counts, in mode auto")
    arguments = parser.parse_args()
    unknown = set(arguments.modes) - set(REFERENCES)
    if unknown and arguments.modes != ["auto"]:
        parser.error(f"modes are {', '.join(REFERENCES)}, or auto alone")
    return arguments


# The package


@functools.cache
def crate():
    """The folder of the published crate. cargo downloads it."""
    subprocess.run(["cargo", "fetch", "--locked"], cwd=PLUGIN, check=True, env=environment())
    home = os.environ.get("CARGO_HOME") or Path.home() / ".cargo"
    found = glob.glob(f"{home}/registry/src/*/bevy-{VERSION}")
    if not found:
        sys.exit(f"bevy {VERSION} is not in {home}/registry")
    return Path(found[0])


def find_example(name):
    found = list(crate().glob(f"examples/**/{name}.rs"))
    if not found:
        sys.exit(f"bevy {VERSION} has no example {name}")
    return found[0]


def write_package(package, examples):
    """A package with a binary of each example. Returns what is wrong with those that cannot be patched."""
    sources = {
        # The same versions as the plugin's tests.
        "Cargo.lock": (PLUGIN / "Cargo.lock").read_text(),
        "Cargo.toml": (HERE / "Cargo.toml.in").read_text().replace("BEVY_AFTERIMAGE", str(PLUGIN)),
        "src/foreign.rs": (HERE / "foreign.rs").read_text(),
        "src/bin/compare/main.rs": (HERE / "compare.rs").read_text(),
        "src/bin/compare/headless.rs": (PLUGIN / "examples/common/headless.rs").read_text(),
    }
    for helper in crate().glob("examples/helpers/*.rs"):
        sources[f"src/helpers/{helper.name}"] = helper.read_text()
    problems = {}
    for name, path in examples.items():
        patched, count = patch(path.read_text())
        if count == 1:
            sources[f"src/bin/{name}.rs"] = patched
            # What an example includes lies beside it.
            for text in re.findall(r'include_str!\("([\w.]+)"\)', patched):
                sources[f"src/bin/{text}"] = (path.parent / text).read_text()
        else:
            problems[name] = f"the patch found {count} places to add the plugin"
    for old in set(package.glob("src/**/*.rs")) - {package / path for path in sources}:
        old.unlink()
    for path, text in sources.items():
        write_changed(package / path, text)
    return problems


def write_changed(path, text):
    """What has not changed is not compiled again. cargo adds to the lock file."""
    given = path.with_name(path.name + ".given")
    if path.exists() and given.exists() and given.read_text() == text:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    given.write_text(text)


def patch(source):
    """Adds the plugin after all others: before the application runs."""
    source, count = re.subn(r"\.run\(\)", ".add_plugins(foreign::ForeignPlugin).run()", source)
    return source + '\n#[path = "../foreign.rs"]\nmod foreign;\n', count


def environment(**more):
    return {**os.environ, "CARGO_INCREMENTAL": "0", **more}


def build(package, names):
    """Builds all at once. Returns what is wrong with those that do not compile."""
    bins = [argument for name in [*names, "compare"] for argument in ("--bin", name)]
    command = ["cargo", "build", "--ignore-rust-version", "--keep-going", *bins]
    with open(package / "build.log", "w") as log:
        subprocess.run(command, cwd=package, env=environment(), stderr=log, stdout=log)
    text = (package / "build.log").read_text()
    failed = set(re.findall(r'could not compile `foreign` \(bin "(\w+)"\)', text))
    if not binary(package, "compare").exists() or "compare" in failed:
        sys.exit(f"the build failed: see {package / 'build.log'}")
    return {name: "does not compile: see package/build.log" for name in names if name in failed}


@functools.cache
def target(package):
    command = ["cargo", "metadata", "--no-deps", "--format-version", "1"]
    done = subprocess.run(command, cwd=package, env=environment(), stdout=subprocess.PIPE, check=True)
    return Path(json.loads(done.stdout)["target_directory"])


def binary(package, name):
    return target(package) / "debug" / name


# Assets


def copy_assets(example, source, out):
    """Copies what an example asks for to out/assets. Returns notes on what is missing."""
    notes = []
    names = sorted({match for match in ASSET.findall(example.read_text())})
    wanted = [name for name in names if "/" in name]
    for name in wanted:
        # Models have files beside them, and shaders import others.
        whole = name.endswith((".gltf", ".wesl", ".wgsl"))
        for path in list_assets(source, str(Path(name).parent)) if whole else [name]:
            copy_asset(source, path, out / "assets" / path)
        if not (out / "assets" / name).exists():
            stand_in = STAND_INS.get(name)
            if stand_in and copy_asset(source, stand_in, out / "assets" / name):
                notes.append(f"{stand_in} stands in for {name}")
            else:
                notes.append(f"lacks {name}")
    return notes


def is_git(source):
    return (source / "HEAD").exists()


def git(source, *arguments):
    return subprocess.run(["git", "-C", source, *arguments], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)


def list_assets(source, folder):
    if is_git(source):
        listed = git(source, "ls-tree", "--name-only", "HEAD", f"assets/{folder}/").stdout.decode()
        return [line.removeprefix("assets/") for line in listed.splitlines()]
    return [str(path.relative_to(source)) for path in (source / folder).glob("*") if path.is_file()]


def copy_asset(source, path, target):
    if target.exists():
        return True
    if is_git(source):
        done = git(source, "show", f"HEAD:assets/{path}")
        contents = done.stdout if done.returncode == 0 else None
    else:
        contents = (source / path).read_bytes() if (source / path).is_file() else None
    # A folder, or a file that the copy lacks.
    if not contents or contents.startswith(b"tree HEAD"):
        return False
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_bytes(contents)
    return True


# Runs


def run_example(name, folder, arguments, notes, is_broken):
    """A row for each mode."""
    if is_broken:
        return [{"example": name, "mode": mode, "notes": notes} for mode in arguments.modes]
    runs, rows = {}, []
    for mode in arguments.modes:
        reference = "own" if name in NEED_MSAA else REFERENCES[mode]
        for each in (reference, mode):
            if each not in runs:
                print(f"{name}: {each}", flush=True)
                runs[each] = run(name, each, folder, arguments.out.resolve())
        rows.append(row(name, (reference, mode), runs, folder, notes))
    return rows


def time_auto(name, folder, arguments, notes):
    """Runs each in turn, several times. The fastest of each counts, because other work only adds time."""
    timed = {"FOREIGN_TIMED": f"{arguments.size}x{arguments.frames}", "FOREIGN_FPS": str(arguments.fps)}
    modes = (*AUTO_OVER, "auto")
    runs = {mode: [] for mode in modes}
    for i in range(arguments.rounds):
        for mode in modes:
            print(f"{name}: {mode}", flush=True)
            runs[mode].append(run(name, mode, folder / str(i), arguments.out.resolve(), **timed))
    result = {"example": name, "mode": "auto", "notes": notes, "shaded": runs["auto"][-1]["shaded"]}
    for mode in modes:
        result["notes"] = result["notes"] + [f"{mode}: {note}" for each in runs[mode] for note in each["notes"]]
    cpu = {mode: [each["cpu_ms"] for each in runs[mode] if each["cpu_ms"]] for mode in modes}
    if all(cpu.values()):
        best = min(min(cpu[mode]) for mode in AUTO_OVER)
        result |= {"cpu": cpu, "ratio": min(cpu["auto"]) / best}
    return result


def run(name, mode, folder, out, **timed):
    """Runs an example once. Returns its numbers and its log."""
    shots = folder / mode
    shots.mkdir(parents=True)
    display = ["xvfb-run", "-a", "-s", "-screen 0 1280x800x24"]
    command = [*display, str(binary(out / "package", name)), *ARGUMENTS.get(name, [])]
    more = {"FOREIGN_MODE": mode, "FOREIGN_OUT": str(shots), "BEVY_ASSET_ROOT": str(out), "NO_COLOR": "1"}
    # A desktop's own display is not used.
    more |= {"WAYLAND_DISPLAY": "", "WGPU_BACKEND": "vulkan", **timed}
    log_path = folder / f"{mode}.log"
    with open(log_path, "w") as log:
        process = subprocess.Popen(command, env=environment(**more), stdout=log, stderr=log, start_new_session=True)
        try:
            status = process.wait(TIMEOUT_S)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            status = f"stopped after {TIMEOUT_S} s"
    return read_log(log_path.read_text(errors="replace"), status)


def read_log(text, status):
    lines = {}
    for line in text.splitlines():
        if found := LOG_LINE.match(line):
            lines[" ".join(found.groups())] = None
    panic = re.search(r"panicked at .*\n?.*", text)
    notes = [] if status == 0 else [f"ends with {status}"]
    notes += [panic.group(0).replace("\n", " ")] if panic else []
    notes += re.findall(r"^foreign: (still loading.*)", text, re.M)
    cpu = re.search(r"^foreign: cpu_ms (\S+)", text, re.M)
    shaded = re.findall(r"^foreign: shaded (.*)", text, re.M)
    return {"lines": list(lines), "notes": notes, "cpu_ms": cpu and float(cpu.group(1)), "shaded": shaded}


def row(name, modes, runs, folder, notes):
    reference, shown = (runs[mode] for mode in modes)
    # Lines of runs at full rate are those of the example.
    new = [line for line in shown["lines"] if line not in reference["lines"] and is_told(line)]
    gone = [line for line in reference["lines"] if line not in shown["lines"] and is_told(line)]
    notes = notes + [f"{modes[0]}: {note}" for note in reference["notes"]] + shown["notes"]
    result = {"example": name, "mode": modes[1], "notes": notes, "new": new, "gone": gone, "shaded": shown["shaded"]}
    result["cpu_ms"] = [reference["cpu_ms"], shown["cpu_ms"]]
    command = [binary(folder.parent / "package", "compare"), *(folder / mode for mode in modes)]
    done = subprocess.run([*command, folder / f"{modes[1]}_compared"], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if done.returncode == 0:
        psnr, worst, picture, x, y = done.stdout.decode().split()
        result |= {"psnr": psnr, "worst": worst, "where": f"{picture} at {x}, {y}"}
    else:
        notes.append(f"no comparison: {done.stderr.decode().strip()}")
    return result


def is_told(line):
    return not any(word in line for word in UNTOLD)


# Report


def earlier(out):
    """Rows of examples that ran before, which stay in the table."""
    path = out / "rows.json"
    return json.loads(path.read_text()) if path.exists() else []


def write_report(out, rows):
    rows = sorted(rows, key=lambda row: EXAMPLES.index(row["example"]) if row["example"] in EXAMPLES else len(EXAMPLES))
    if any(row["mode"] == "auto" for row in rows):
        write_times(out, rows)
        return
    lines = [
        "| example | mode | PSNR | worst crop | where | CPU ms a frame, full, then mode | shaded | notes |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for row in rows:
        cpu = " / ".join(f"{ms:.0f}" if ms else "" for ms in row.get("cpu_ms", []))
        cells = [row["example"], row["mode"], *(row.get(key, "") for key in ("psnr", "worst", "where")), cpu]
        cells += [", ".join(row.get("shaded", [])), "; ".join(row["notes"])]
        lines.append("| " + " | ".join(cell.replace("|", "/") for cell in cells) + " |")
    lines += ["", "Lines of the log that full rate does not have (+), or has alone (-):", ""]
    for row in rows:
        lines += [f"- {row['example']} {row['mode']}: + {line}" for line in row.get("new", [])]
        lines += [f"- {row['example']} {row['mode']}: - {line}" for line in row.get("gone", [])]
    (out / "table.md").write_text("\n".join(lines) + "\n")
    (out / "rows.json").write_text(json.dumps(rows, indent=1))


def write_times(out, rows):
    modes = (*AUTO_OVER, "auto")
    lines = [f"| example | {' | '.join(modes)} | ratio | shaded | notes |", "|---|---|---|---|---|---|---|"]
    for row in rows:
        cpu = row.get("cpu", {})
        cells = [row["example"], *(", ".join(f"{ms:.0f}" for ms in cpu.get(mode, [])) for mode in modes)]
        cells += [f"{row['ratio']:.2f}" if "ratio" in row else "", ", ".join(row["shaded"]), "; ".join(row["notes"])]
        lines.append("| " + " | ".join(cell.replace("|", "/") for cell in cells) + " |")
    (out / "table.md").write_text("\n".join(lines) + "\n")
    (out / "rows.json").write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
