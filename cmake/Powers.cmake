# Powers: folders of studies that can be left out of the build. KAPITZA_POWERS chooses which of them are built; nothing else includes them.

set(KAPITZA_POWERS all CACHE STRING "powers that are built, separated by semicolons; all, or empty for none")
set_property(GLOBAL PROPERTY kapitza_powers "")

# kapitza_power(name FOLDERS folder of src ... [FILES file of src or include ...] [SCRIPT file] [STUDIES study ...] [PARTS part ...] [KEYS key ...] [COMMANDS command ...] [NEEDS power ...] [BESIDE file or folder ...]):
# with its folders left out, its studies and commands are refused by the name of the power. The order of the studies is that in which they
# run, after those of the core. PARTS are parts of the study basin, with a row as a study has; KEYS are
# the keys that they add. FILES are of the power too, and stand in folders of the core: its headers in include/kapitza. SCRIPT finds a library that
# it needs. BESIDE are its tests, its part of the package and of the explorer and its pages, which scripts/ledger counts.
set(KAPITZA_KINDS STUDIES PARTS KEYS COMMANDS)
function(kapitza_power name)
  cmake_parse_arguments(arg "" "" "FOLDERS;FILES;SCRIPT;NEEDS;BESIDE;${KAPITZA_KINDS}" ${ARGN})
  foreach(list FOLDERS FILES SCRIPT NEEDS ${KAPITZA_KINDS})
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

set(KAPITZA_LEFT_OUT "") # folders of powers that are not built
foreach(power ${known})
  foreach(kind ${KAPITZA_KINDS})
    get_property(items GLOBAL PROPERTY kapitza_power_${power}_${kind})
    foreach(item ${items})
      if(power IN_LIST chosen)
        string(APPEND power_${kind} " ITEM(${item})")
      else()
        string(APPEND missing_${kind} " MISSING(${item}, ${power})")
      endif()
    endforeach()
  endforeach()
  get_property(script GLOBAL PROPERTY kapitza_power_${power}_SCRIPT)
  if(power IN_LIST chosen AND script)
    include(${script})
  endif()
  if(NOT power IN_LIST chosen)
    get_property(folders GLOBAL PROPERTY kapitza_power_${power}_FOLDERS)
    list(APPEND KAPITZA_LEFT_OUT ${folders})
  endif()
endforeach()
set(KAPITZA_CHOSEN ${chosen})
string(APPEND power_STUDIES "${power_PARTS}")
string(APPEND missing_STUDIES "${missing_KEYS}")
configure_file(cmake/powers.h.in ${PROJECT_BINARY_DIR}/include/kapitza/powers.h @ONLY)
