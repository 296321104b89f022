# Powers: what the program can do beyond the two papers. KAPITZA_POWERS chooses which of them are built; the core includes nothing of any of
# them. A power is one folder, or one in each of two layers.

set(KAPITZA_POWERS all CACHE STRING "powers that are built, as \"atlas;live\"; all, or empty for what the two papers ask")
set_property(GLOBAL PROPERTY kapitza_powers "")

# kapitza_power(name FOLDERS folder of src ... [STUDIES study ...] [NEEDS power ...]): with its folders left out, its studies are refused
# by the name of the power. The order of the studies is that in which they run, after those of the core.
function(kapitza_power name)
  cmake_parse_arguments(arg "" "" "FOLDERS;STUDIES;NEEDS" ${ARGN})
  foreach(list FOLDERS STUDIES NEEDS)
    set_property(GLOBAL PROPERTY kapitza_power_${name}_${list} ${arg_${list}})
  endforeach()
  set_property(GLOBAL APPEND PROPERTY kapitza_powers ${name})
endfunction()

include(${CMAKE_CURRENT_LIST_DIR}/power_list.cmake)

get_property(known GLOBAL PROPERTY kapitza_powers)
set(chosen ${KAPITZA_POWERS})
if(chosen STREQUAL "all")
  set(chosen ${known})
endif()
foreach(power ${chosen})
  if(NOT power IN_LIST known)
    message(FATAL_ERROR "KAPITZA_POWERS: ${power} is no power; there are ${known}")
  endif()
  get_property(needs GLOBAL PROPERTY kapitza_power_${power}_NEEDS)
  foreach(need ${needs})
    if(NOT need IN_LIST chosen)
      message(FATAL_ERROR "KAPITZA_POWERS: ${power} needs ${need} too")
    endif()
  endforeach()
endforeach()

set(power_studies "")
set(missing_studies "")
set(KAPITZA_LEFT_OUT "") # folders of powers that are not built
foreach(power ${known})
  get_property(studies GLOBAL PROPERTY kapitza_power_${power}_STUDIES)
  get_property(folders GLOBAL PROPERTY kapitza_power_${power}_FOLDERS)
  foreach(study ${studies})
    if(power IN_LIST chosen)
      string(APPEND power_studies " STUDY(${study})")
    else()
      string(APPEND missing_studies " MISSING(${study}, ${power})")
    endif()
  endforeach()
  if(NOT power IN_LIST chosen)
    list(APPEND KAPITZA_LEFT_OUT ${folders})
  endif()
endforeach()
configure_file(cmake/powers.h.in ${PROJECT_BINARY_DIR}/include/kapitza/powers.h @ONLY)
