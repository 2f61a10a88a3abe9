// A client of a running Studio that sends it any bytes, well-formed or not.
#pragma once

#include <string_view>

namespace glint::fuzz {

// Sends the requests in `bytes`, one a connection, to a Studio that serves until the program ends.
// Lines "== NEXT" part them. Of what a client cannot know beforehand they hold names, which are
// replaced: {HOST}, {COOKIE}, {CAPTURE} … (Names() in the .cc).
//
// Throws UserError where Studio refused one of them; std::logic_error where it then no longer
// answers a good request, has told what lies outside its folder, or has written there.
void SendToStudio(std::string_view bytes);

}  // namespace glint::fuzz
