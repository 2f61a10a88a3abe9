#include "base/memory/machine_memory.h"

#include <gtest/gtest.h>

#include "tests/support/process.h"

namespace glint {
namespace {

class Cgroup : public testing::Test {
 protected:
  void Write(const std::string& file, const std::string& text) {
    std::filesystem::create_directories((folder_.path() / file).parent_path());
    test::WriteAll(folder_.path() / file, text);
  }
  std::uint64_t Limit() const {
    return CgroupMemory_bytes(folder_.path() / "self", folder_.path() / "root");
  }
  test::TemporaryFolder folder_;
};

TEST_F(Cgroup, TheLeastLimitFromTheGroupUpwardsHolds) {
  Write("self", "0::/job/step\n");
  EXPECT_EQ(Limit(), 0u);
  Write("root/job/step/memory.max", "max\n");
  EXPECT_EQ(Limit(), 0u);
  Write("root/job/memory.max", "4000000000\n");
  EXPECT_EQ(Limit(), 4000000000u);
  Write("root/job/step/memory.max", "3000000000\n");
  EXPECT_EQ(Limit(), 3000000000u);
}

TEST_F(Cgroup, VersionOneHasAControllerForMemory) {
  Write("self", "3:cpu,cpuacct:/a\n2:memory:/a\n");
  Write("root/a/memory.max", "1\n");
  Write("root/memory/a/memory.limit_in_bytes", "2000000000\n");
  EXPECT_EQ(Limit(), 2000000000u);
}

TEST(MachineMemory, IsThatOfSomeMachine) { EXPECT_GT(MachineMemory_bytes(), 100000000u); }

}  // namespace
}  // namespace glint
