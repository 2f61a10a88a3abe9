#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <thread>

#include "fitting/weights/safetensors.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using test::ReadAll;
using test::RunProgram;

const std::string kScript = std::string(GLINT_SOURCE_DIR) + "/training/gpu_run.sh";

// The script at small scale on the CPU, with `folder` for all it writes.
class GpuRun {
 public:
  GpuRun() {
    ::setenv("OUT", out().c_str(), 1);
    ::setenv("TRAINER", (fs::path(GLINT_BIN_DIR) / "glint-train").c_str(), 1);
    ::setenv("DEVICE", "cpu", 1);
    ::setenv("BATCH", "4", 1);
    ::setenv("PHOTOGRAPHS", "8", 1);
    ::setenv("CROPS", "32", 1);
    ::setenv("CHANNELS", "8,12,16,16,24,8,16", 1);
    ::setenv("LR", "2e-3", 1);
    ::setenv("PART_BYTES", "60000", 1);
    for (const char* other : {"MATERIALS", "PACK", "POOL_THREADS"}) ::unsetenv(other);
  }
  ~GpuRun() { RunProgram({kScript, "stop"}); }

  fs::path out() const { return folder_.path() / "run"; }

  Outcome Train(std::vector<std::string> options) const {
    std::vector<std::string> arguments{kScript, "60",
                                       "--",    "--material-size",
                                       "64",    "--pool-first",
                                       "32",    "--pool-window",
                                       "32",    "--pool-per-step",
                                       "0.2",   "--warmup",
                                       "20",    "--average-decay",
                                       "0.98",  "--report-seconds",
                                       "0.1",   "--checkpoint-minutes",
                                       "0.01",  "--bf16",
                                       "0"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return RunProgram(arguments);
  }
  Outcome Wait() const { return RunProgram({kScript, "wait", "50"}); }

  // The lines of the loss log, by column.
  std::vector<double> Losses(const std::string& column) const {
    std::istringstream log(ReadAll(out() / "estimator.safetensors.csv"));
    std::string line, cell;
    std::getline(log, line);
    std::istringstream header(line);
    int wanted = -1;
    for (int k = 0; std::getline(header, cell, ','); ++k) {
      if (cell == column) wanted = k;
    }
    std::vector<double> values;
    while (std::getline(log, line)) {
      std::istringstream cells(line);
      for (int k = 0; std::getline(cells, cell, ','); ++k) {
        if (k == wanted) values.push_back(std::atof(cell.c_str()));
      }
    }
    return values;
  }

 private:
  test::TemporaryFolder folder_;
};

template <class Condition>
bool Soon(const Condition& condition) {
  for (int i = 0; i < 400; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

TEST(GpuRunScript, TrainsFromNothingGoesOnAfterAKillAndReturnsFromAJump) {
  const GpuRun run;
  const Outcome begun = run.Train({"--steps", "100000"});
  ASSERT_EQ(begun.code, 0) << begun.err;
  EXPECT_NE(run.Train({}).code, 0);  // one is running already
  ASSERT_TRUE(Soon([&] { return fs::exists(run.out() / "estimator.safetensors.checkpoint"); }))
      << ReadAll(run.out() / "log");
  ASSERT_EQ(::kill(-std::stoi(ReadAll(run.out() / "pid")), SIGKILL), 0);
  const Outcome killed = run.Wait();
  EXPECT_NE(killed.code, 0);
  EXPECT_THAT(killed.err, testing::HasSubstr("go on from its checkpoint"));

  const auto before = static_cast<std::int64_t>(run.Losses("step").back());
  const std::string jump = std::to_string(before + 60), end = std::to_string(before + 260);
  ASSERT_EQ(run.Train({"--steps", end, "--test-jump", jump}).code, 0);
  const Outcome done = run.Wait();
  EXPECT_EQ(done.code, 0) << ReadAll(run.out() / "log");
  EXPECT_THAT(done.out, testing::HasSubstr("done"));
  EXPECT_THAT(ReadAll(run.out() / "log"), testing::HasSubstr("with half the learning rate"));
  const std::vector<double> losses = run.Losses("map"), steps = run.Losses("step");
  EXPECT_GT(steps.back(), static_cast<double>(before));  // not from nothing again
  const double most = *std::max_element(losses.begin(), losses.end());
  EXPECT_TRUE(std::isfinite(losses.back()));
  EXPECT_LT(losses.back(), 0.6 * most);
}

TEST(GpuRunScript, SplitsTheWeightsIntoPartsThatJoinToWhatWasWritten) {
  const GpuRun run;
  ASSERT_EQ(run.Train({"--steps", "3"}).code, 0);
  ASSERT_EQ(run.Wait().code, 0) << ReadAll(run.out() / "log");
  const fs::path parts = run.out() / "weights";
  for (const auto& entry : fs::directory_iterator(parts)) {
    EXPECT_LE(fs::file_size(entry), 60000u) << entry;
  }
  const Outcome joined = RunProgram({parts / "join.sh"});
  EXPECT_EQ(joined.code, 0) << joined.err;
  for (const char* name : {"estimator.safetensors", "estimator_float32.safetensors"}) {
    EXPECT_EQ(ReadAll(parts / name), ReadAll(run.out() / name)) << name;
    EXPECT_NO_THROW(ReadTensorFile(parts / name));
  }
  EXPECT_EQ(ReadTensorFile(parts / "estimator.safetensors").tensors[0].dtype, "BF16");
  EXPECT_EQ(ReadTensorFile(parts / "estimator_float32.safetensors").tensors[0].dtype, "F32");
}

TEST(GpuRunScript, SaysWhatIsWrongWithItsArguments) {
  const GpuRun run;
  EXPECT_THAT(RunProgram({kScript, "ten"}).err, testing::HasSubstr("MINUTES: found ten"));
  EXPECT_THAT(RunProgram({kScript, "1", "no.safetensors"}).err,
              testing::HasSubstr("FROM: found no.safetensors"));
  EXPECT_THAT(RunProgram({kScript, "--help"}).out, testing::HasSubstr("MATERIALS"));
}

}  // namespace
}  // namespace glint
