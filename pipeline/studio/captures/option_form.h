// Options as a form shows them, made from what the stages' programs say of themselves (--describe),
// and what of them capture.toml holds.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "base/files/json.h"
#include "base/formats/capture.h"

namespace glint {

// {stages: [{name, summary, options: […]}]}, with "sample", "run" and "tile" for what is no stage's
// option. Starts each stage's program once; keep the result. `cancelled` ends it early, with
// options missing.
Json OptionForm(const std::function<bool()>& cancelled = {});

// What capture.toml holds, by stage: {"fit": {"metals": "possible"}, "sample": {…}, …}.
Json SavedOptions(const Capture& capture);

// capture.toml with changed options, {stage: {option: value or null}}; `form` is OptionForm().
// Throws HttpError 422 for an option that is none, or a value out of its range; UserError where the
// file cannot be changed.
std::string WithOptions(const Capture& capture, const std::string& text, const Json& changes,
                        const Json& form);

}  // namespace glint
