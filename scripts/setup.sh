# Set-up that ./demo and ./check share; to be sourced, with the repository's root as the current directory.
# shellcheck shell=bash

export LC_ALL=C.UTF-8

packages=(
  g++ clang clang-14 libclang-rt-14-dev cmake ninja-build
  libglm-dev libtinygltf-dev nlohmann-json3-dev libopenimageio-dev openimageio-tools catch2 libhwy-dev libtbb-dev
  libcli11-dev libmeshoptimizer-dev libxxhash-dev libpng-dev libturbojpeg0-dev libembree-dev gnuplot-nox
)

# Installs the packages that are missing; does not touch apt when there are none.
install_packages() {
  if ! command -v dpkg-query > /dev/null; then
    echo "not a Debian system: assuming that these are installed: ${packages[*]}" >&2
    return 0
  fi
  local missing=() installed package
  installed=$(dpkg-query -W -f='${Package} ${db:Status-Status}\n' "${packages[@]}" 2> /dev/null || true)
  for package in "${packages[@]}"; do
    grep -qxF "$package installed" <<< "$installed" || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0

  local root=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo > /dev/null; then
      echo "missing packages, and no sudo to install them: ${missing[*]}" >&2
      return 1
    fi
    root=(sudo)
  fi
  echo "installing: ${missing[*]}"
  "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q &&
    "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
}

# build_preset NAME: configures once (the build tool does it again when a CMake file changes) and builds.
build_preset() {
  if [ ! -f "build/$1/build.ninja" ]; then
    cmake --preset "$1" || return 1
  fi
  cmake --build --preset "$1"
}

# make_demo_scene NAME FILE: the demo scene, by the program of that build; kept while it is newer than the program.
make_demo_scene() {
  local program=build/$1/bin/obscura-scene
  [ "$2" -nt "$program" ] || "$program" demo -o "$2"
}
