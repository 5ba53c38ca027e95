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

obscura_script_test(unit devices_matrix_test)
obscura_script_test(unit include_order_test)
obscura_script_test(unit price_needs_test)
obscura_script_test(unit price_remedies_test)
obscura_script_test(unit readme_test)
obscura_script_test(unit report_test)
obscura_script_test(unit test_scenes)
# Minutes on slow devices: only ctest -C devices runs these, as .ci/run does.
function(obscura_devices_test name)
  add_test(NAME ${name} CONFIGURATIONS devices
           COMMAND ${OBSCURA_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/devices/${name}.py)
  set_tests_properties(${name} PROPERTIES LABELS devices ENVIRONMENT "OBSCURA_PROGRAM=$<TARGET_FILE:obscura>;${ARGN}")
endfunction()

if(TARGET obscura)
  obscura_devices_test(oclgrind_test OCLGRIND_WORKAROUNDS=$<TARGET_FILE:oclgrind_workarounds>)
  obscura_devices_test(rusticl_test)
  obscura_script_test(unit usage_test)
  obscura_script_test(conformance check_test)
  obscura_script_test(conformance check_ray_test)
  obscura_script_test(image bench_command_test)
  obscura_script_test(image device_list_test)
  obscura_script_test(image interrupt_test)
  obscura_script_test(image options_test)
  obscura_script_test(image output_errors_test)
  obscura_script_test(image small_stack_test)
  obscura_script_test(image readme_examples_test)
  obscura_script_test(image reference_command_test)
  obscura_script_test(image sweep_command_test)
  obscura_script_test(image trace_file_test)
  # R_ave and I_A of every scene against a computation that shares no code with the program.
  foreach(scene cornell furnace kitchen planes sphere wall)
    add_test(NAME radiometry_of_${scene} COMMAND ${OBSCURA_PYTHON} -B ${PROJECT_SOURCE_DIR}/tools/check_radiometry.py
             $<TARGET_FILE:obscura> ${PROJECT_SOURCE_DIR}/scenes/${scene})
    set_tests_properties(radiometry_of_${scene} PROPERTIES LABELS unit)
  endforeach()
endif()
