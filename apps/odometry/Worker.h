// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <functional>
#include <thread>
#include <utility>

namespace pointplane
{
/** Runs `work` on a thread of its own and keeps its exception. Its end is waited for. */
class Worker
{
 public:
    explicit Worker(std::function<void()> work)
        : thread_(
              [this, work = std::move(work)]
              {
                  try
                  {
                      work();
                  }
                  catch (...)
                  {
                      error_ = std::current_exception();
                  }
              })
    {
    }
    ~Worker() { join(); }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    void join()
    {
        if (thread_.joinable())
        {
            thread_.join();
        }
    }
    /** After join(). */
    void rethrow() const
    {
        if (error_)
        {
            std::rethrow_exception(error_);
        }
    }

 private:
    std::exception_ptr error_;
    std::thread thread_;
};
}  // namespace pointplane
