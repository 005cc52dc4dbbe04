# calibench: `just` lists the recipes. On a fresh machine call them through `./bootstrap RECIPE`, which installs what is missing first.

# One package set and one profile for everything: other sets resolve other features and build the world twice. Of the versions of Cargo.lock, always.
everything := "--locked --release --workspace"
calibench := "./target/release/calibench"

# Snapshots are compared and not written; `INSTA_UPDATE=always just test` accepts what is there now.
export INSTA_UPDATE := env("INSTA_UPDATE", "no")

# The tools' own packages, where `./bootstrap peers` put them; without them the tests that ask them are skipped, by name.
export CALIBENCH_PEERS := if path_exists(justfile_directory() / "target/peers") == "true" { justfile_directory() / "target/peers" } else { "" }

# The Python package, where `./bootstrap python` put it; without it its tests are skipped, by name.
export CALIBENCH_PYTHON := if path_exists(justfile_directory() / "target/python/wheels") == "true" { justfile_directory() / "target/python" } else { "" }

# Chromium's environment, where `./bootstrap browser` put it; without it the tests that open pages are skipped, by name.
export CALIBENCH_BROWSER := if path_exists(justfile_directory() / "target/browser") == "true" { justfile_directory() / "target/browser" } else { "" }

# List the recipes
default:
    @just --list --unsorted

# Build everything
build:
    cargo build {{everything}} --quiet

# Run every scenario and write reports/
bench: build
    {{calibench}} run --all --pages
    {{calibench}} report

# Run all tests; the last line is their sum. What crosses crates runs beside the crates' own tests: either alone leaves a processor idle at the end of each crate
test:
    #!/usr/bin/env bash
    set -uo pipefail
    mkdir -p target
    cargo test {{everything}} --no-run 2>&1 | tee target/test.log
    [ "${PIPESTATUS[0]}" -eq 0 ] || exit 1
    # By target and not by package: other packages resolve other features and build the world twice.
    own=()
    for file in harness/*/tests/*/main.rs; do own+=(--test "$(basename "$(dirname "$file")")"); done
    {
        cargo test {{everything}} --lib --bins "${own[@]}" --no-fail-fast
        units=$?
        cargo test {{everything}} --doc --no-fail-fast && [ "$units" -eq 0 ]
    } > target/test-crates.log 2>&1 &
    cargo test {{everything}} --test calibench --no-fail-fast 2>&1 | tee target/test-across.log
    across=${PIPESTATUS[0]}
    wait "$!"
    crates=$?
    cat target/test-crates.log
    cat target/test-across.log target/test-crates.log >> target/test.log
    just summary
    [ "$across" -eq 0 ] && [ "$crates" -eq 0 ]

# Words in the names of tests that take seconds each: `just quick` leaves these tests to `just test`.
long := "efficiency bare_edges in_every_cell crowded the_bound_is_reached noise_and_bare_edges light_costs_no_more what_stands_beside without_noise_the_bias pooled_errors spots_are_no_far gradients a_method_that_is_added rendered_images_are points_serve_with have_the_origin"

# The tests of CRATE (as `measure`) and of the crates that call it, without OpenCV and without what takes long: below a minute after a change of one line
quick CRATE:
    #!/usr/bin/env bash
    set -euo pipefail
    callers=$(cargo tree --locked --quiet --invert calibench-{{CRATE}} --depth 1 --prefix none --edges normal | cut -d' ' -f1 | grep '^calibench-' | sort -u)
    packages=(--package calibench-{{CRATE}})
    for package in $callers; do
        case $package in calibench-cli | calibench-judge | calibench-opencv | calibench-point | calibench-python | calibench-tests) ;; *) packages+=(--package "$package") ;; esac
    done
    skips=()
    for name in {{long}}; do skips+=(--skip "$name"); done
    cargo test --locked --profile quick --lib --quiet "${packages[@]}" -- "${skips[@]}"
    echo "not tested: cli, judge, point, OpenCV, Python, what crosses crates, and tests that take long (\`just --evaluate long\`): \`just test\` does"

# What is left to the night, and the sum of the last test run
summary:
    @echo "not tested, left to 'just nightly': $(grep -l '^nightly = true' scenarios/*/*.toml | sed 's|^scenarios/||; s|[.]toml$||' | paste -sd ' ')"
    @awk '/^test result:/ { passed += $4; failed += $6; skipped += $8 } END { printf "%d passed, %d failed, %d skipped\n", passed, failed, skipped }' target/test.log
    @awk '/^test .* FAILED$/ { print "failed: " $2 } /panicked at/ { print; getline; print }' target/test.log

# What every change leaves out because it is large only to be large: before each release
nightly: build wheel
    {{calibench}} check --strict --locked --nightly
    {{calibench}} run --all
    {{calibench}} run networks/free-many networks/rig-many networks/acceptance-photographs tasks/lengths-many
    {{calibench}} run $(cd scenarios && ls league/*.toml | sed 's|[.]toml$||')
    {{calibench}} check --strict --locked --nightly --records records
    {{calibench}} check --strict --locked --nightly --against records --records records
    CALIBENCH_NIGHTLY=1 cargo test {{everything}} --test calibench determinism
    target/python/bin/python -m pytest -q -p no:cacheprovider harness/python/tests/test_size.py

# Compare all numbers with reference/baselines; exit 1 and a table if any is worse, changed without a bless, or not blessed
check: build
    {{calibench}} check --strict --locked

# What the gate sees and how often it is wrong, on the shipped baselines: docs/gate-power.md
power: build
    {{calibench}} gate-power > docs/gate-power.md.new
    mv docs/gate-power.md.new docs/gate-power.md

# Accept today's accuracy as the baseline, after looking
bless: build
    {{calibench}} bless

# Formatting, lints and docs; every warning is an error
lint:
    cargo fmt --all --check
    cargo clippy {{everything}} --all-targets --quiet -- -D warnings
    RUSTDOCFLAGS="-D warnings" cargo doc {{everything}} --no-deps --quiet
    sh -n bootstrap
    sh -n .ci/league-env

# Camera files that we write, read and projected by the tools' own packages (`./bootstrap peers` installs them)
peers:
    cargo test {{everything}} --test calibench peers::

# What other tools' numbers mean, asked of them: every script of findings/, or NAME..., and their sum (docs/peers.md); some minutes, packages of several indexes
findings *NAMES:
    #!/usr/bin/env bash
    set -uo pipefail
    mkdir -p target/findings
    names=({{NAMES}})
    [ "${#names[@]}" -gt 0 ] || for script in findings/*.sh; do names+=("$(basename "$script" .sh)"); done
    passed=0 failed=0 skipped=0
    for name in "${names[@]}"; do
        "findings/$name.sh" > "target/findings/$name.log" 2>&1
        case $? in
        0) passed=$((passed + 1)); echo "as stated      $name" ;;
        2) skipped=$((skipped + 1)); echo "not asked      $name: $(tail -1 "target/findings/$name.log")" ;;
        *) failed=$((failed + 1)); echo "NOT AS STATED  $name: target/findings/$name.log" ;;
        esac
    done
    echo "$passed passed, $failed failed, $skipped skipped"
    [ "$failed" -eq 0 ]

# The environments of the league's systems, each in one version, pinned, in target/league: NAME... or --all; --list lists them
league-env *NAMES:
    .ci/league-env {{NAMES}}

# Small faults in what scores, gates, adjusts and reports that no test of its crate notices: COUNT mutants by SEED, at most MINUTES (`./bootstrap mutants` installs cargo-mutants)
mutants SEED="2026" COUNT="200" MINUTES="60":
    .ci/mutants {{SEED}} {{COUNT}} {{MINUTES}}

# Licences and sources of all dependencies, and advisories against them where their database can be reached (`./bootstrap deny` installs cargo-deny)
deny:
    #!/usr/bin/env bash
    set -euo pipefail
    mkdir -p target
    cargo deny check licenses bans sources
    if cargo deny fetch db 2>target/advisories.log; then
        cargo deny check --disable-fetch advisories
    else
        echo "advisories NOT CHECKED: their database cannot be reached (target/advisories.log)"
    fi

# Points per second of every operator, of cameras, milliseconds of the recognition, and seconds of adjustments, beside their peers (`./bootstrap perf` installs mrcal and Ceres)
perf:
    cargo bench --locked --workspace --bench perf --bench cameras --bench bundles --bench boards --bench recognition --bench campaigns --bench bounds

# How often sound calibrations are doubted, and planted mistakes named: COUNT draws of each sound kind, a tenth of that of each mistake
doubts COUNT="1000":
    cargo bench --locked --quiet --workspace --bench doubts -- {{COUNT}}

# What the tests open pages in (`./bootstrap browser` installs it)
browser:
    @chromium --version
    @chromedriver --version

# The Python package, installed in target/python from the one build that serves all (`./bootstrap python` makes that environment)
python: build
    target/python/bin/python harness/python/install.py
    touch target/python/pyvenv.cfg

# The Python package to be given away: its wheel in target/wheels, in a build of its own
wheel:
    target/python/bin/maturin build --quiet --compression-level 9 --manifest-path harness/python/Cargo.toml --out target/wheels

# What the Python package costs beyond the program, beside the command line
perf-python: python
    target/python/bin/python harness/python/benches/perf.py

# Two workers of Dask beside two processes started by hand, at so many minutes of trials: six times that, on a quiet machine
perf-cluster minutes="5": python
    target/python/bin/python harness/python/benches/cluster.py {{minutes}}

# What weighs most in the wheel: its sections, crates and functions
size-python: wheel
    # The library once more with the symbols that the wheel is without.
    cargo build --locked --profile wheel --quiet --package calibench-python
    target/python/bin/python harness/python/benches/size.py

# Boards found, how well and how fast, beside OpenCV on the same images
perf-boards: python
    RAYON_NUM_THREADS=1 target/python/bin/python harness/python/benches/boards.py
    RAYON_NUM_THREADS=1 target/python/bin/python harness/python/benches/chessboards.py

# Chessboards in wide lenses with their truth, SCENES in each of four fields, and frames that have none: tables, and what was not found (2000 in some 20 minutes)
perf-wide SCENES="500":
    SCENES={{SCENES}} cargo test --locked --release -p calibench-detect --test detect -- --ignored --nocapture --test-threads 1 many_

# Undistorted pictures of 12 megapixels beside OpenCV 5's remap with ready maps, on one thread, in turn (`./bootstrap peers` installs it)
perf-undistort ROUNDS="3":
    cargo build {{everything}} --quiet --example time
    RAYON_NUM_THREADS=1 target/peers/bin/python harness/undistort/benches/remap.py target/release/examples/time {{ROUNDS}}

# Seconds of whole commands beside Python with OpenCV that does the same, and how they grow
perf-commands: python
    target/python/bin/python harness/python/benches/commands.py

# Seconds of whole commands on points and cameras beside pycolmap and OpenCV 5, in turn (`./bootstrap peers` installs them); `--before PROGRAM` beside an earlier build
perf-networks *OPTIONS: build
    target/peers/bin/python harness/python/benches/networks.py {{OPTIONS}}

# Seconds and memory of measure, intersect and calibrate by the number of rows, up to ten million
rows:
    cargo bench --locked --workspace --bench rows

# Every reader of files against mutated ones: seconds for each reader, and a seed that makes the same files again
fuzz seconds="60" seed="15":
    CALIBENCH_FUZZ_SECONDS={{seconds}} CALIBENCH_FUZZ_SEED={{seed}} cargo test {{everything}} --test calibench fuzz::no_reader -- --nocapture

# Every crate's package in target/package, each built from what is in it alone (`--allow-dirty` for changes that are not committed)
package *OPTIONS:
    # Of a version that cargo has once unpacked and built it takes no new one: without this, packages would be built on those of last time.
    rm -rf "${CARGO_HOME:-$HOME/.cargo}"/registry/src/-*/calibench-* target/debug/.fingerprint/calibench-*
    CARGO_PROFILE_DEV_DEBUG=0 cargo package --locked --workspace --exclude calibench-tests --exclude calibench-python {{OPTIONS}}

# The pages of docs/ as a book, target/book/index.html: their commands run, their figures are made (`./bootstrap docs` installs mdBook in target/tools)
docs: build
    python3 docs/book/build.py {{calibench}} target/tools/bin/mdbook

# What the book is built with (`./bootstrap book` installs it)
book:
    @target/tools/bin/mdbook --version

# Write the JSON Schemas of scenario files, and of what commands answer with --json in their present version
schema: build
    #!/usr/bin/env bash
    set -euo pipefail
    {{calibench}} schema scenarios > scenarios/scenario.schema.json.new
    mv scenarios/scenario.schema.json.new scenarios/scenario.schema.json
    for command in calibrate calibrate-rig calibrate-splined judge judge-rig convert camera diff list measure accept task; do
        {{calibench}} schema $command > docs/schemas/new
        version=$(python3 -c 'import json; print(json.load(open("docs/schemas/new"))["properties"]["schema"]["const"])')
        mv docs/schemas/new docs/schemas/$command-$version.schema.json
    done
