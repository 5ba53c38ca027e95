# embed_kernels(FOLDER OUTPUT): a C++ source file that holds every kernel source under FOLDER as text, so that an
# installed program finds its kernels anywhere. It is written anew whenever one of them changes, comes or goes.
if(NOT CMAKE_SCRIPT_MODE_FILE)
  set(EMBED_KERNELS_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

  function(embed_kernels folder output)
    file(GLOB_RECURSE files CONFIGURE_DEPENDS ${folder}/*.cl ${folder}/*.clh ${folder}/*.h)
    add_custom_command(
      OUTPUT ${output}
      COMMAND ${CMAKE_COMMAND} -D FOLDER=${folder} -D OUTPUT=${output} -P ${EMBED_KERNELS_SCRIPT}
      DEPENDS ${files} ${EMBED_KERNELS_SCRIPT}
      COMMENT "Embedding the kernels"
      VERBATIM)
  endfunction()
  return()
endif()

file(GLOB_RECURSE paths RELATIVE ${FOLDER} ${FOLDER}/*.cl ${FOLDER}/*.clh ${FOLDER}/*.h)
list(SORT paths COMPARE STRING)
set(entries "")
foreach(path IN LISTS paths)
  file(READ ${FOLDER}/${path} text)
  string(APPEND entries "    {\"${path}\", R\"kernel_text(${text})kernel_text\"},\n")
endforeach()
file(WRITE ${OUTPUT} "// Generated from kernels/ by tools/cmake/embed_kernels.cmake.
#include \"device/kernel_source.h\"

namespace obscura {

namespace {

constexpr EmbeddedFile FILES[] = {
${entries}};

}  // namespace

std::span<const EmbeddedFile> embedded_kernel_files() { return FILES; }

}  // namespace obscura
")
