glint_program(glint-calib SOURCES main_calib.cc DEPENDS glint_calib_capture glint_programs fmt::fmt)
glint_program(glint-board SOURCES main_board.cc DEPENDS glint_printing glint_programs)
glint_program(glint-response SOURCES main_response.cc
              DEPENDS glint_response glint_programs glint_linearize fmt::fmt spdlog::spdlog)
