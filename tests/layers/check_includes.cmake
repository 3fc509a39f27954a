# Reads every #include line and fails, naming file and line, where a layer includes upwards or a library is
# used outside its one home. Run as: cmake -DROOT=<repository> -P check_includes.cmake
cmake_minimum_required(VERSION 3.25)
set(below_smlm "")
set(below_core smlm)
set(below_flames smlm core)
set(below_model smlm core flames)
set(below_latent smlm core flames model)
set(below_fusion smlm core flames)
set(below_registration smlm core flames model latent fusion)
set(below_simulation ${below_registration} registration)
set(below_results ${below_simulation} simulation)
set(below_fitting ${below_results} results)
set(below_report ${below_fitting} fitting)
set(below_pipeline ${below_report} report)
set(below_cli ${below_pipeline} pipeline)
set(layers smlm core flames model latent fusion registration simulation results fitting report pipeline cli)

# Library header -> the place (a pattern) that alone may include it.
set(homes
  "tbb/=src/core/parallel"
  "openssl/=src/core/sha256"
  "Random123/=src/core/rng"
  "nanoflann=src/flames/"
  "ceres/=src/(fusion|fitting)/"
  "yaml-cpp/=src/pipeline/config/parse"
  "hdf5=smlm/src/h5/"
  "matio=smlm/src/"
  "png.h=src/results/"
  "tiffio.h=src/results/"
  "kainjow/=src/report/layout"
  "CLI/=src/cli/")

function(check_file file layer)
  file(RELATIVE_PATH shown ${ROOT} ${file})
  file(READ ${file} text)
  string(REPLACE ";" "," text "${text}")  # a list separator to CMake
  string(REPLACE "[" "(" text "${text}")
  string(REPLACE "]" ")" text "${text}")
  string(REPLACE "\n" ";" lines "${text}")
  set(number 0)
  foreach(line IN LISTS lines)
    math(EXPR number "${number} + 1")
    if(NOT line MATCHES "^[ \t]*#[ \t]*include[ \t]*[<\"]([^>\"]+)[>\"]")
      continue()
    endif()
    set(included ${CMAKE_MATCH_1})
    set(target "")
    if(included MATCHES "^polar/([a-z]+)/")
      set(target ${CMAKE_MATCH_1})
    elseif(included MATCHES "^([a-z]+)/")
      set(target ${CMAKE_MATCH_1})  # smlm, or another layer's private header
    endif()
    if(target IN_LIST layers AND NOT target STREQUAL layer AND NOT target IN_LIST below_${layer})
      message(SEND_ERROR "${shown}:${number}: ${layer} must not include ${target} (\"${included}\")")
    endif()
    foreach(home IN LISTS homes)
      string(REGEX MATCH "^([^=]+)=(.+)$" unused ${home})
      set(prefix ${CMAKE_MATCH_1})
      set(folder ${CMAKE_MATCH_2})
      if(included MATCHES "^${prefix}" AND NOT shown MATCHES "^${folder}")
        message(SEND_ERROR "${shown}:${number}: <${included}> belongs in ${folder} only")
      endif()
    endforeach()
  endforeach()
endfunction()

set(checked 0)
foreach(layer IN LISTS layers)
  if(layer STREQUAL smlm)
    file(GLOB_RECURSE sources ${ROOT}/smlm/*.hpp ${ROOT}/smlm/*.cpp)
  else()
    file(GLOB_RECURSE sources ${ROOT}/include/polar/${layer}/*.hpp ${ROOT}/src/${layer}/*.hpp
         ${ROOT}/src/${layer}/*.cpp)
  endif()
  foreach(source IN LISTS sources)
    check_file(${source} ${layer})
    math(EXPR checked "${checked} + 1")
  endforeach()
endforeach()
if(checked EQUAL 0)
  message(FATAL_ERROR "no sources found under '${ROOT}'")
endif()
message(STATUS "${checked} files read")
