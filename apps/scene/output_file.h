// Files that appear whole or not at all.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace limn::scene {

/// What could not be written, with the reason and the remedy. The program ends with exit status 4.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Writes a file whole or not at all: without a name (O_TMPFILE) or, where the file system has no such files,
/// under a temporary name beside it; then it gets its name in one step. An existing file is replaced, but not
/// one without write permission; a symbolic link is followed; devices and pipes are written to as they are.
///
/// The process may be killed at any moment. The data are not forced to the disk (no fsync): after a power
/// failure a file may be empty or short, which readers of PNG notice, --skip-existing among them. Throws
/// OutputError.
void writeFileWhole(const std::string& path, const void* bytes, std::size_t count);

/// Writes to an open descriptor, standard output for example; `name` is for the message. Throws OutputError.
void writeAll(int descriptor, const std::string& name, const void* bytes, std::size_t count);

/// Makes the directories that `path` lies in. Throws OutputError.
void makeDirectoriesOf(const std::string& path);

/// Throws OutputError where writeFileWhole(path), after makeDirectoriesOf(path), is sure to fail; writes nothing.
void requireWritable(const std::string& path);

/// Removes the temporary files of writes in progress and holds all further ones back for good: for a process
/// that is about to end on a signal, from a thread of its own.
void abandonWrites();

}  // namespace limn::scene
