glint_program(glint SOURCES main_glint.cc DEPENDS glint_driver)
# It only starts other programs: without the libraries it does not use, in milliseconds.
target_link_options(glint PRIVATE -Wl,--as-needed)
glint_program(glint-init SOURCES main_init.cc DEPENDS glint_driver glint_triage)
glint_program(glint-run SOURCES main_run.cc DEPENDS glint_driver)
glint_program(glint-status SOURCES main_status.cc DEPENDS glint_driver)
glint_program(glint-verify SOURCES main_verify.cc DEPENDS glint_driver)
glint_program(glint-export SOURCES main_export.cc DEPENDS glint_export)
glint_program(glint-report SOURCES main_report.cc DEPENDS glint_report)
