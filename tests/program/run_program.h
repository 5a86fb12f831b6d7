// Runs the real program as a user does, in a directory of its own.
#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace limn::test {

struct Result {
  int status = -1;  ///< exit status, or -n when ended by signal n
  std::size_t peakBytes = 0;
  double processorSeconds = 0;  ///< of all threads
  std::string out, err;
};

/// A process that runs beside the test.
class Running {
 public:
  /// `limits`: bytes that a file may have, 0 = no limit.
  Running(const std::filesystem::path& directory, const std::vector<std::string>& arguments,
          const std::string& input, unsigned long fileSizeLimit = 0);
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  void signal(int number) const;
  Result wait();

 private:
  std::filesystem::path streams_;
  pid_t process_ = -1;
};

class ProgramTest : public testing::Test {
 protected:
  ProgramTest();
  ~ProgramTest() override;

  Result limn(const std::vector<std::string>& arguments, const std::string& input = "") const;
  std::filesystem::path path(const std::string& name) const { return directory_ / name; }
  std::string contents(const std::string& name) const;
  void write(const std::string& name, const std::string& bytes) const;
  /// Names in a folder, sorted, hidden ones too.
  std::vector<std::string> names(const std::string& folder) const;

  std::filesystem::path directory_;  ///< where the program runs
};

/// Words joined to one list.
std::vector<std::string> operator+(std::vector<std::string> words, const std::vector<std::string>& more);

}  // namespace limn::test
