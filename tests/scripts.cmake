# Tests that are Python scripts. Each is one CTest entry, with the label of its folder like any other test:
# obscura_script_test(LABEL NAME) runs tests/LABEL/NAME.py, which finds the program in OBSCURA_PROGRAM.
# Debian's own Python is the one that sees Debian's numpy.
find_program(OBSCURA_PYTHON python3 HINTS /usr/bin NO_CMAKE_ENVIRONMENT_PATH REQUIRED)

function(obscura_script_test label name)
  add_test(NAME ${name} COMMAND ${OBSCURA_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/${label}/${name}.py)
  set_tests_properties(${name} PROPERTIES LABELS ${label})
  if(TARGET obscura)
    set_tests_properties(${name} PROPERTIES ENVIRONMENT OBSCURA_PROGRAM=$<TARGET_FILE:obscura>)
  endif()
endfunction()

obscura_script_test(unit include_order_test)
obscura_script_test(unit readme_test)
if(TARGET obscura)
  obscura_script_test(image options_test)
  obscura_script_test(image readme_examples_test)
endif()
