glint_program(glint-synth SOURCES main_synth.cc
  DEPENDS glint_synth glint_material_pack glint_procedural glint_statistics glint_programs fmt::fmt)
glint_program(glint-eval SOURCES main_eval.cc
  DEPENDS glint_evaluation glint_synth glint_programs fmt::fmt spdlog::spdlog Eigen3::Eigen)
glint_program(glint-import SOURCES main_import.cc
  DEPENDS glint_guidance glint_import glint_rectified_views glint_programs fmt::fmt)
