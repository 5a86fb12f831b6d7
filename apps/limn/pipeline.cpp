#include "apps/limn/pipeline.h"

#include <algorithm>
#include <utility>

namespace limn::program {
namespace {

/// One is drawn while each thread finishes one, if so much memory may be taken; at least two.
std::size_t pictureCount(int threads, std::size_t bytesPerPicture) {
  constexpr std::size_t kMemory = 512U << 20;
  if (threads == 1) return 1;
  return std::clamp<std::size_t>(kMemory / std::max<std::size_t>(bytesPerPicture, 1), 2,
                                 static_cast<std::size_t>(threads) + 1);
}

}  // namespace

Pipeline::Pipeline(int threads, std::size_t bytesPerPicture, std::function<void(Picture&)> finish)
    : threads_(threads), finish_(std::move(finish)), arena_(std::max(1, threads - 1), 0) {
  count_ = pictureCount(threads, bytesPerPicture);
  for (std::size_t i = 0; i < count_; ++i) free_.push_back(std::make_unique<Picture>());
}

Pipeline::~Pipeline() {
  std::unique_lock lock(mutex_);
  while (!waiting_.empty()) {
    free_.push_back(std::move(waiting_.front()));
    waiting_.pop_front();
  }
  changed_.wait(lock, [&] { return free_.size() >= count_ && enqueued_ == 0; });
}

void Pipeline::rethrowFailure() {
  if (failure_) std::rethrow_exception(failure_);
}

void Pipeline::finishOne(std::unique_lock<std::mutex>& lock) {
  if (waiting_.empty()) return;
  std::unique_ptr<Picture> picture = std::move(waiting_.front());
  waiting_.pop_front();
  if (!failure_) {
    lock.unlock();
    std::exception_ptr failure;
    try {
      finish_(*picture);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    if (failure && !failure_) failure_ = failure;
  }
  free_.push_back(std::move(picture));
  changed_.notify_all();
}

std::unique_ptr<Picture> Pipeline::acquire() {
  std::unique_lock lock(mutex_);
  while (free_.empty()) {
    if (waiting_.empty())
      changed_.wait(lock);
    else
      finishOne(lock);
  }
  rethrowFailure();
  std::unique_ptr<Picture> picture = std::move(free_.back());
  free_.pop_back();
  --count_;
  return picture;
}

void Pipeline::submit(std::unique_ptr<Picture> picture) {
  {
    const std::lock_guard lock(mutex_);
    ++count_;
    waiting_.push_back(std::move(picture));
    // With one thread, acquire() and drain() finish it. They also do where the workers are busy drawing: tasks that have not
    // begun must not pile up, so there are no more than can run, and each finishes all it finds.
    if (enqueued_ + 1 >= static_cast<std::size_t>(threads_)) return;
    ++enqueued_;
  }
  arena_.enqueue([this] {
    std::unique_lock lock(mutex_);
    while (!waiting_.empty()) finishOne(lock);
    --enqueued_;
    changed_.notify_all();
  });
}

void Pipeline::drain() {
  std::unique_lock lock(mutex_);
  while (free_.size() < count_) {
    if (waiting_.empty())
      changed_.wait(lock);
    else
      finishOne(lock);
  }
  rethrowFailure();
}

void InOrder::run(int position, const std::function<void()>& write) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return next_ == position || abandoned_; });
  if (abandoned_) return;
  write();  // the lock is held: nobody else may write anyway
  ++next_;
  changed_.notify_all();
}

void InOrder::abandon() {
  const std::lock_guard lock(mutex_);
  abandoned_ = true;
  changed_.notify_all();
}

}  // namespace limn::program
