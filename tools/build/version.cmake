# Writes OUT with the commit of SOURCE if it has changed. Every build runs this.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --exclude=* --abbrev=12
  OUTPUT_VARIABLE id OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed ERROR_QUIET)
if(failed)
  set(id "unknown")
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT [[
#include "build/version.h"

namespace railstep {

const char* version_text() { return "@VERSION@, git @id@"; }

}  // namespace railstep
]] @ONLY)
