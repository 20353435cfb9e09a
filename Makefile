# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
# Short names; the work is done by scripts/ and CMake.
.PHONY: demo test check format tidy bench
PRESET ?= dev

demo:
	scripts/demo
test:
	scripts/test
check:
	scripts/check
format:
	scripts/format
tidy:
	scripts/tidy
bench:
	cmake --preset release
	cmake --build --preset release --target benchmarks
	for program in build/release/bench_*; do $$program || exit 1; done
