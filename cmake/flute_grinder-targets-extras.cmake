# The targets flute_grinder::base, ::curve, ::job and ::motion. In a workspace that is one project they are there already.
include(CMakeFindDependencyMacro)
find_dependency(Threads)
# For job and motion alone: a package of the curve needs neither.
find_package(OpenSSL QUIET COMPONENTS Crypto)
find_package(yaml-cpp QUIET)
if(NOT TARGET flute_grinder::curve)
  include("${flute_grinder_DIR}/flute_grinder-targets.cmake")
endif()
