// The tables of docs/model.md, in Markdown, from the headers of base/model.
#pragma once

#include <string>

namespace glint::test {

// A number as a person writes it: at most four digits, a fraction where these are not enough.
std::string NumberText(double value);

// Constants of the model with units and sources, and those of solvers.
std::string ModelTable();
std::string SolverTable();

}  // namespace glint::test
