# A thin front of the CMake presets. On a Debian machine `make demo` and `make check` install what is missing.
SHELL := /bin/bash
.SHELLFLAGS := -eu -o pipefail -c

# What building, drawing and testing need.
PACKAGES := g++ cmake ninja-build pkg-config git \
  libglm-dev libtinygltf-dev libstb-dev libtbb-dev libhwy-dev libcli11-dev nlohmann-json3-dev libmeshoptimizer-dev \
  libdeflate-dev libpng-dev libxxhash-dev libgtest-dev libbenchmark-dev librapidcheck-dev
# What `make check` needs besides.
CHECK_PACKAGES := clang clang-format clang-tidy libclang-rt-14-dev assimp-testmodels xxhash
# What `make bench` needs besides: gnuplot draws its pictures, Mesa's OSMesa is the peer in the race, F3D (on an X server
# without a screen) is what people draw glTF files with, chromium opens the report to see that it works.
BENCH_PACKAGES := gnuplot-nox fonts-dejavu-core python3 libgl-dev libosmesa6 f3d xvfb xauth chromium

.PHONY: help build demo pictures api check check-all bench fuzz format packages check-packages bench-packages

help:
	@echo "make demo       install what is missing, build, draw the demonstration frames into out/"
	@echo "make build      the program (build/release/apps/limn) and the bench programs (build/release/bench)"
	@echo "make api        the library's headers as pages, in build/api/html"
	@echo "make check      formatting, clang-tidy, the tests with g++ and clang++, the sanitizers"
	@echo "make check-all  the full matrix: compilers, optimisation levels, long fuzzing"
	@echo "make bench      the benchmarks"
	@echo "make fuzz       hostile models for FUZZ_SECONDS (60); what it finds goes to build/fuzz"

# $(call install,LIST): quick where everything is there.
define install
	@missing=""; for p in $(1); do \
	  dpkg-query -W -f='$${Status}' $$p 2>/dev/null | grep -q 'ok installed' || missing="$$missing $$p"; done; \
	if [ -n "$$missing" ]; then \
	  echo "limn: installing$$missing"; \
	  if [ "$$(id -u)" = 0 ]; then sudo=; else sudo=sudo; fi; \
	  $$sudo apt-get update -q >/dev/null && \
	  DEBIAN_FRONTEND=noninteractive $$sudo apt-get install -y -q --no-install-recommends $$missing >/dev/null || \
	  { echo "limn: could not install the packages; as root: apt-get install$$missing" >&2; exit 1; }; fi
endef

packages:
	$(call install,$(PACKAGES))
check-packages: packages
	$(call install,$(CHECK_PACKAGES))
bench-packages: packages
	$(call install,$(BENCH_PACKAGES))

# $(call compile,PRESET,TARGETS)
compile = cmake --preset $(1) --log-level=WARNING >/dev/null && cmake --build --preset $(1) $(if $(2),--target $(2)) -- --quiet

build: packages
	@$(call compile,release,apps/all bench/all)

demo: build
	@build/release/apps/limn render builtin:demo --method flat -o out/demo-flat.png
	@build/release/apps/limn render builtin:demo --method patches -o out/demo-smooth.png
	@build/release/apps/limn render builtin:knot-480 --turntable 12 --size 640x400 -o out/knot-%02d.png
	@echo "limn: the same coarse meshes, flat in out/demo-flat.png and smooth in out/demo-smooth.png; a turn of a knot in out/knot-*.png"

# The pictures of the README, the manual and the page of options.
pictures: build
	@build/release/bench/limn_pictures docs/pictures
	@cd docs && PATH="$(CURDIR)/build/release/apps:$$PATH" ./run_commands.sh options.md

# The public headers as pages.
api:
	$(call install,doxygen)
	@doxygen docs/Doxyfile
	@echo "limn: the library's headers as pages, build/api/html/index.html"

SOURCES = $(shell git ls-files '*.cpp' '*.h')

format: check-packages
	@clang-format -i $(SOURCES)

# The sanitizer build is clang++'s test run; the clang build only shows that its optimised pixels are the same.
check: check-packages
	@clang-format --dry-run -Werror $(SOURCES)
	@$(call compile,release)
	@$(call compile,clang,apps/all)
	@$(call compile,sanitize)
	@tests/same_pixels.sh build/release build/clang build/sanitize
	@ctest --preset sanitize
	@tests/tidy.sh build/sanitize
	@ctest --preset release

# The full matrix; the other compilers of Debian are used where they are installed.
check-all: check
	@tests/tidy.sh build/sanitize all
	@tests/matrix.sh
	@$(MAKE) --no-print-directory fuzz FUZZ_SECONDS=1200

# All figures, in less than ten minutes, into bench/results; the page with all of them is bench/results/report.html.
bench: bench-packages
	@cmake --preset release -D LIMN_BUILD_PEER=ON --log-level=WARNING >/dev/null
	@$(call compile,release,apps/all bench/all)
	@bench/run.py

# What a run finds is mended, and the input kept in tests/fuzz/corpus, where every later run starts.
FUZZ_SECONDS ?= 60
FUZZ = -max_total_time=$$(($(FUZZ_SECONDS) / 2)) -timeout=20 -rss_limit_mb=1024 -print_final_stats=1
fuzz: check-packages
	@$(call compile,fuzz,limn_fuzz_loader limn_fuzz_frame)
	@mkdir -p build/fuzz/loader build/fuzz/frame
	build/fuzz/tests/fuzz/limn_fuzz_loader $(FUZZ) -max_len=65536 -dict=tests/fuzz/gltf.dict \
	  -artifact_prefix=build/fuzz/loader- build/fuzz/loader tests/fuzz/corpus/loader
	build/fuzz/tests/fuzz/limn_fuzz_frame $(FUZZ) -max_len=4096 \
	  -artifact_prefix=build/fuzz/frame- build/fuzz/frame tests/fuzz/corpus/frame
