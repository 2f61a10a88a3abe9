glint_program(glint-calib SOURCES main_calib.cc DEPENDS glint_calib_capture glint_contract fmt::fmt)
glint_program(glint-board SOURCES main_board.cc DEPENDS glint_printing glint_contract)
glint_program(glint-response SOURCES main_response.cc
              DEPENDS glint_response glint_contract glint_linearize fmt::fmt spdlog::spdlog)
