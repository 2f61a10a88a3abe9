glint_program(glint-synth SOURCES main_synth.cc
  DEPENDS glint_synth glint_procedural glint_contract fmt::fmt)
glint_program(glint-eval SOURCES main_eval.cc
  DEPENDS glint_evaluation glint_synth glint_contract fmt::fmt spdlog::spdlog Eigen3::Eigen)
