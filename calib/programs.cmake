glint_program(glint-calib SOURCES main_calib.cc DEPENDS glint_calib_capture glint_contract fmt::fmt)
