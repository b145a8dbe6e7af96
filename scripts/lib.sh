# Shared by the scripts here; source it, do not run it.
# Every package is Debian 12's own; nothing is downloaded from elsewhere.

build_packages=(
  g++ cmake ninja-build ccache pkg-config
  libeigen3-dev libfmt-dev nlohmann-json3-dev libtomlplusplus-dev libcli11-dev
  libudunits2-dev libqhull-dev libsuitesparse-dev libmetis-dev libopenblas-dev
  libspectra-dev libtet1.5-dev libnlopt-dev libnlopt-cxx-dev libceres-dev
  libboost-dev libsqlite3-dev libvtk9-dev lib3mf-dev
  libocct-data-exchange-dev libocct-ocaf-dev
  pybind11-dev python3-dev python3-numpy
)
# The report page is built by npm; where somebody else's Node.js is installed,
# which has npm in it, Debian's own would not go beside it.
command -v npm >/dev/null || build_packages+=(nodejs npm)
run_packages=(xvfb libudunits2-data)
test_packages=(
  libgtest-dev libgmock-dev libbenchmark-dev clang-format clang-tidy
  calculix-ccx evolver evolver-doc tetgen admesh gmsh git locales python3
  libpetsc-real-dev openmpi-bin chromium python3-scipy
)

gallery_packages=(python3 python3-pil)
fuzz_packages=(clang libclang-rt-14-dev)

# step COMMAND...: runs it and notes its wall clock and processor time for
# print_times().
step_times=()
step() {
  local began=$SECONDS used
  used=$(cpu_seconds)
  "$@"
  step_times+=("$(printf '%6d s  %6d s  %s' $((SECONDS - began)) \
    $(($(cpu_seconds) - used)) "$(printf '%s ' "$@" | cut -c1-60)")")
}
# Of this shell's finished children, whole seconds.
cpu_seconds() {
  awk '{printf "%d", ($16 + $17) / 100}' /proc/$$/stat
}
print_times() {
  say "Times: wall clock, processor, step"
  printf '%s\n' "${step_times[@]}"
}

# The programs of tests/bench, which build() leaves out.
build_benches() {
  cmake --build --preset release --target benches --parallel "$(nproc)" \
    -- --quiet
}

say() { printf '\n== %s\n' "$*"; }

# need PACKAGE...: installs those that are missing, as root or with sudo.
need() {
  local missing=() package
  for package in "$@"; do
    if [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" \
      != installed ]; then
      missing+=("$package")
    fi
  done
  if [ ${#missing[@]} -eq 0 ]; then
    echo "All $# Debian packages are installed."
    return
  fi
  echo "Installing ${#missing[@]} of $# Debian packages: ${missing[*]}"
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || {
      echo "error: not root and no sudo; install by hand: apt-get install" \
        "${missing[*]}" >&2
      exit 1
    }
    as_root=(sudo)
  fi
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq \
    --no-install-recommends "${missing[@]}" >/dev/null
}

# build OPTION...: configures once and builds with the preset "release".
build() {
  say "Building (preset release, build/release)"
  cmake --preset release "$@" >build-configure.log 2>&1 || {
    cat build-configure.log >&2
    rm -f build-configure.log
    exit 1
  }
  rm -f build-configure.log
  # More at once than cores only makes them wait for memory.
  cmake --build --preset release --parallel "$(nproc)" -- --quiet
}
