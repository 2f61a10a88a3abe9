#include "pipeline/studio/workspace/options_meanwhile.h"

#include <chrono>

#include "pipeline/studio/captures/option_form.h"

namespace glint {

void OptionsMeanwhile::Prepare() {
  preparing_ = std::thread([this] {
    constexpr auto kLater = std::chrono::seconds(2);  // the first page comes first
    {
      std::unique_lock<std::mutex> guard(mutex_);
      if (end_.wait_for(guard, kLater, [&] { return ending_.load(); })) return;
    }
    Form();
  });
}

const Json& OptionsMeanwhile::Form() {
  std::call_once(made_, [this] { form_ = OptionForm([this] { return ending_.load(); }); });
  return form_;
}

void OptionsMeanwhile::Stop() {
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    ending_ = true;
    end_.notify_all();
  }
  if (preparing_.joinable()) preparing_.join();
}

}  // namespace glint
