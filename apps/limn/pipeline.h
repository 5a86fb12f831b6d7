// Finishing frames (hash, encode, write) beside the drawing of the next ones.
//
// A fixed number of pictures goes round: drawn by the calling thread, finished by whoever has time. Threads are those of
// TBB that help with the drawing too, and when every picture is in use the calling thread finishes one itself, so
// never more than `threads` threads work and none idles. Memory does not depend on the number of frames.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include <tbb/task_arena.h>

#include "apps/scene/frame.h"
#include "apps/scene/image.h"

namespace limn::program {

/// One frame on its way to its file.
struct Picture {
  int position = 0;       ///< in the list of frames that this run draws, from 0
  int frame = 1;          ///< number in the job
  bool existing = false;  ///< not drawn: its file is whole already
  std::string hash;       ///< of the pixels
  std::vector<std::string> aovHashes;
  scene::Image image;
  scene::Planes planes;
  Projection projection;
};

class Pipeline {
 public:
  /// `finish` is called once for every submitted picture, from several threads at a time.
  Pipeline(int threads, std::size_t bytesPerPicture, std::function<void(Picture&)> finish);
  /// Leaves out what has not begun, waits for the rest.
  ~Pipeline();
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  /// A picture to draw into. Helps to finish others until one is free. Rethrows what `finish` threw.
  std::unique_ptr<Picture> acquire();
  /// Pictures are begun in the order in which they are submitted.
  void submit(std::unique_ptr<Picture> picture);
  /// Finishes all. Rethrows what `finish` threw.
  void drain();

 private:
  /// Finishes the oldest waiting picture, if there is one.
  void finishOne(std::unique_lock<std::mutex>& lock);
  void rethrowFailure();

  const int threads_;
  const std::function<void(Picture&)> finish_;
  tbb::task_arena arena_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::unique_ptr<Picture>> free_;
  std::deque<std::unique_ptr<Picture>> waiting_;
  std::size_t count_ = 0;     ///< pictures in all
  std::size_t enqueued_ = 0;  ///< tasks of the arena that have not ended
  std::exception_ptr failure_;
};

/// Lets pictures write to standard output one after the other in the order of their positions.
class InOrder {
 public:
  /// Waits until all before `position` are through, then calls `write`. Where `write` throws, abandon() must follow.
  void run(int position, const std::function<void()>& write);

  /// One picture failed, in its turn or before: the later ones wait no more, throw nothing and write nothing.
  void abandon();

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int next_ = 0;
  bool abandoned_ = false;
};

}  // namespace limn::program
