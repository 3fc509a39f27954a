# A kernel's object for AVX may not define a weak symbol: the linker could keep that copy of an inline function
# for the whole program, and a machine without AVX would meet its instructions.
#   cmake -DNM=nm -DOBJECTS="a.o;b.o" -P kernels_free_standing.cmake
if(NOT OBJECTS)
  message(FATAL_ERROR "no object was given")
endif()
foreach(object IN LISTS OBJECTS)
  execute_process(COMMAND ${NM} --defined-only -C ${object} OUTPUT_VARIABLE symbols RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${NM} failed on ${object}")
  endif()
  string(REGEX MATCHALL "[^\n]* [WVu] [^\n]*" weak "${symbols}")
  if(weak)
    message(FATAL_ERROR "${object} defines weak symbols: ${weak}")
  endif()
endforeach()
