# Compiler flags of all host code, and obscura_module(): one static library per folder of host/.
add_library(obscura_options INTERFACE)
target_compile_options(obscura_options INTERFACE
  -Wall -Wextra -Wshadow -Wconversion -Wdouble-promotion
  # Bit-identical results need the same expressions everywhere: no contraction into FMA.
  -ffp-contract=off
  # __FILE__ in messages is relative, so that an installed program doesn't name the folder it was built in.
  -fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=)
if(OBSCURA_WERROR)
  target_compile_options(obscura_options INTERFACE -Werror)
endif()
if(SANITIZER)
  target_compile_options(obscura_options INTERFACE -fsanitize=${SANITIZER} -fno-omit-frame-pointer)
  target_link_options(obscura_options INTERFACE -fsanitize=${SANITIZER})
endif()
target_include_directories(obscura_options INTERFACE
  ${PROJECT_SOURCE_DIR}/host ${PROJECT_SOURCE_DIR}/kernels)

# obscura_module(NAME SOURCES a.cpp ... DEPENDS lib ...)
function(obscura_module name)
  cmake_parse_arguments(MODULE "" "" "SOURCES;DEPENDS" ${ARGN})
  add_library(obscura_${name} STATIC ${MODULE_SOURCES})
  target_link_libraries(obscura_${name} PUBLIC obscura_options ${MODULE_DEPENDS})
endfunction()
