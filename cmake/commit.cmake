# Writes OUT, which says from which commit of SOURCE the program is built; leaves it where it says that already. Nothing where there is no git.
execute_process(COMMAND git -C ${SOURCE} rev-parse --short=12 HEAD OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
execute_process(COMMAND git -C ${SOURCE} status --porcelain --untracked-files=no OUTPUT_VARIABLE changed ERROR_QUIET)
if(commit AND changed)
  string(APPEND commit ", changed since")
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT "namespace marey::cli {\nextern const char* const kCommit;\nconst char* const kCommit = \"${commit}\";\n}  // namespace marey::cli\n" @ONLY)
