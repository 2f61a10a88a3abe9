// Numbers that say where they come from.
#pragma once

#include <string>

#include "base/files/json.h"

namespace glint {

// A value of a manifest: which one, and which field. Shown as the number's tooltip.
struct Trace {
  std::string manifest;  // relative to the report: "../fit/manifest.json"
  std::string field;     // "metrics.final_loss"

  Trace Field(const std::string& name) const {
    return {manifest, field.empty() ? name : field + "." + name};
  }
  Trace Index(size_t i) const { return {manifest, field + "[" + std::to_string(i) + "]"}; }
};

// The value as text, with its trace.
std::string FigureHtml(const Json& value, const Trace& trace);

// A large figure with what it is below; for the head of a section.
std::string HeadFigure(const std::string& label, const Json& value, const Trace& trace,
                       const std::string& unit = "");

// Link to a manifest for the corner of a section.
std::string SourceLink(const std::string& manifest);

}  // namespace glint
