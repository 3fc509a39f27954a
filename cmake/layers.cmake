# How a layer becomes a library: polar_layer(<name> SOURCES ... DEPENDS ... [PRIVATE_DEPENDS ...]).
# The include directory of the whole project is public; which layer may include which is
# held by tests/unit/layers (a guard that reads the includes).

add_library(polar_options INTERFACE)
target_compile_options(polar_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion
  $<$<BOOL:${POLAR_WARNINGS_AS_ERRORS}>:-Werror>
  -ffp-contract=off) # the same bits whatever the compiler fuses; kernels ask for FMA by name
if(POLAR_SANITIZE)
  target_compile_options(polar_options INTERFACE -fsanitize=${POLAR_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(polar_options INTERFACE -fsanitize=${POLAR_SANITIZE})
endif()

function(polar_layer name)
  cmake_parse_arguments(LAYER "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  add_library(polar_${name} STATIC ${LAYER_SOURCES})
  add_library(polar::${name} ALIAS polar_${name})
  set_target_properties(polar_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(polar_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                                  $<INSTALL_INTERFACE:include>
                                           PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(polar_${name} PUBLIC ${LAYER_DEPENDS}
                                      PRIVATE polar_options ${LAYER_PRIVATE_DEPENDS})
endfunction()

# A kernel written once on vector extensions and compiled once per instruction set; the
# namespace each copy lives in comes from POLAR_ISA, the choice is made at run time.
# Further arguments are compiler options.
function(polar_kernel target source)
  get_filename_component(stem ${source} NAME_WE)
  set(variants portable)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    list(APPEND variants avx2 avx512)
  endif()
  set(flags_portable "")
  set(flags_avx2 -mavx2 -mfma -mprefer-vector-width=256)
  set(flags_avx512 -mavx512f -mavx512dq -mavx512bw -mavx512vl -mfma -mprefer-vector-width=512)
  foreach(variant ${variants})
    set(copy ${CMAKE_CURRENT_BINARY_DIR}/${stem}_${variant}.cpp)
    file(GENERATE OUTPUT ${copy} CONTENT
      "#define POLAR_ISA ${variant}\n#include \"${CMAKE_CURRENT_SOURCE_DIR}/${source}\"\n")
    set_source_files_properties(${copy} PROPERTIES
      COMPILE_OPTIONS "${flags_${variant}};-O3;-ffp-contract=fast;-fno-math-errno;-fno-trapping-math;-Wno-psabi;${ARGN}"
      OBJECT_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${source})
    target_sources(${target} PRIVATE ${copy})
  endforeach()
endfunction()

# Files that become part of the program, so that it needs no path of the machine: sets <variable> to a source that
# defines <namespace>::embedded_texts(), a map from their names to their texts. `header` declares it.
function(polar_embed variable header namespace)
  get_filename_component(stem ${header} NAME_WE)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/embedded_${stem}.cpp)
  add_custom_command(OUTPUT ${source}
    COMMAND ${CMAKE_COMMAND} "-DFILES=${ARGN}" -DOUTPUT=${source} -DHEADER=${header} -DNAMESPACE=${namespace}
            -P ${PROJECT_SOURCE_DIR}/cmake/embed.cmake
    DEPENDS ${ARGN} ${PROJECT_SOURCE_DIR}/cmake/embed.cmake
    VERBATIM)
  set(${variable} ${source} PARENT_SCOPE)
endfunction()
