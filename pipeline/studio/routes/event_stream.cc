#include "pipeline/studio/routes/event_stream.h"

#include <cstdint>
#include <memory>

namespace glint {

HttpReply EventStream(EventHub* events, const std::string& only,
                      const std::function<bool()>& may_listen) {
  constexpr double kPatience_s = 15;
  HttpReply reply;
  reply.type = "text/event-stream";
  auto seen = std::make_shared<std::uint64_t>(events->Now());
  auto begun = std::make_shared<bool>(false);
  reply.stream = [events, only, may_listen, seen, begun](std::string* text) {
    if (!*begun) {
      *begun = true;
      *text = "retry: 1000\n\n";
      return true;
    }
    return may_listen() && events->Next(seen.get(), only, kPatience_s, text);
  };
  return reply;
}

}  // namespace glint
