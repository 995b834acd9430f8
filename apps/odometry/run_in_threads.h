// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/BoundedQueue.h>

#include <cstddef>
#include <future>
#include <utility>

namespace pointplane
{
/** Closes a queue where its scope ends, by an exception, too: who waits for it goes on. */
template <class T>
struct Closer
{
    BoundedQueue<T>& queue;
    ~Closer() { queue.close(); }
};
template <class T>
Closer(BoundedQueue<T>&) -> Closer<T>;

/** Passes items on until there is none, or none is taken any more.
 * \param next () -> std::optional<Item> \param take (Item) -> bool */
template <class Next, class Take>
void passOn(const Next& next, const Take& take)
{
    while (auto item = next())
    {
        if (!take(std::move(*item)))
        {
            return;
        }
    }
}

/** Each of the three in a thread of its own, item after item. The first that throws ends the
 * others, and its exception is thrown here.
 * \param read () -> std::optional<In>, nothing at the end \param work (In) -> Out
 * \param write (const Out&) */
template <class Read, class Work, class Write>
void runInThreads(const Read& read, const Work& work, const Write& write)
{
    using In = typename decltype(read())::value_type;
    using Out = decltype(work(std::declval<In>()));
    constexpr std::size_t kDepth = 4;  // items waiting between two threads
    BoundedQueue<In> waiting(kDepth);
    BoundedQueue<Out> done(kDepth);
    auto reader = std::async(
        std::launch::async,
        [&]
        {
            const Closer closer{waiting};
            passOn(read, [&](In item) { return waiting.push(std::move(item)); });
        });
    const Closer endsReader{waiting};  // where there is no memory for another thread
    auto writer = std::async(
        std::launch::async,
        [&]
        {
            const Closer closer{done};  // a writer that fails stops the others
            while (auto item = done.pop())
            {
                write(*item);
            }
        });
    const Closer endsWriter{done};
    auto worker = std::async(
        std::launch::async,
        [&]
        {
            const Closer closesOut{done};
            const Closer closesIn{waiting};
            passOn(
                [&] { return waiting.pop(); },
                [&](In item) { return done.push(work(std::move(item))); });
        });
    worker.wait();
    reader.wait();
    writer.get();
    worker.get();
    reader.get();
}
}  // namespace pointplane
