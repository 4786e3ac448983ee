// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

namespace pcbmesh::validation::checks {

/// Calls work(worker, task) once for each task in [0, num_tasks), on up to num_threads threads. The first exception is
/// rethrown. Which worker gets which task is not fixed: results must be kept per task, or be sums of integers.
template <class Work>
void for_each_task(int num_threads, std::int64_t num_tasks, Work&& work) {
  const int workers = static_cast<int>(std::clamp<std::int64_t>(num_tasks, 1, std::max(1, num_threads)));
  if (workers == 1) {
    for (std::int64_t task = 0; task < num_tasks; ++task) work(0, task);
    return;
  }
  std::atomic<std::int64_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_lock;
  const auto run = [&](int worker) {
    try {
      for (std::int64_t task = next++; task < num_tasks; task = next++) work(worker, task);
    } catch (...) {
      next = num_tasks;
      const std::lock_guard<std::mutex> hold(failure_lock);
      if (!failure) failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> threads;
    for (int worker = 1; worker < workers; ++worker) threads.emplace_back(run, worker);
    run(0);
  }
  if (failure) std::rethrow_exception(failure);
}

inline constexpr std::int64_t slice_length = 1 << 16;

/// Calls work(worker, slice, first, last) for slices of fixed length: results kept per slice and joined in order are
/// the same for any number of threads.
template <class Work>
void for_each_slice(int num_threads, std::int64_t num_items, Work&& work) {
  for_each_task(num_threads, (num_items + slice_length - 1) / slice_length, [&](int worker, std::int64_t slice) {
    work(worker, slice, slice * slice_length, std::min(num_items, (slice + 1) * slice_length));
  });
}

struct PartitionPlan {
  int num_threads = 1;
  std::int64_t num_items = 0;
  std::int64_t num_partitions = 1;
  std::int64_t max_entries_at_once = 0;  ///< a single larger partition is still taken whole
};

/// Distributes entries over partitions small enough for the cache, then hands each partition over.
///
/// scan(first, last, emit) calls emit(partition, entry) for the items [first, last), the same way whenever it is called:
/// it runs once to count and once per pass to fill. consume(worker, partition, entries) may reorder its entries.
/// Entries reach a partition in the order of the items, whatever the number of threads.
/// @cost max_entries_at_once entries of memory; sequential writes only, so shuffled ids cost little.
template <class Entry, class Scan, class Consume>
void partition_entries(const PartitionPlan& plan, Scan&& scan, Consume&& consume) {
  const std::int64_t num_slices = std::clamp<std::int64_t>(plan.num_items / 4096, 1, 4 * std::max(1, plan.num_threads));
  const auto slice_start = [&](std::int64_t slice) { return plan.num_items * slice / num_slices; };
  std::vector<std::vector<std::int64_t>> offsets(static_cast<std::size_t>(num_slices));
  for_each_task(plan.num_threads, num_slices, [&](int, std::int64_t slice) {
    std::vector<std::int64_t> counts(static_cast<std::size_t>(plan.num_partitions), 0);
    scan(slice_start(slice), slice_start(slice + 1),
         [&](std::int64_t partition, const Entry&) { ++counts[static_cast<std::size_t>(partition)]; });
    offsets[static_cast<std::size_t>(slice)] = std::move(counts);
  });
  std::vector<std::int64_t> starts(static_cast<std::size_t>(plan.num_partitions) + 1, 0);
  for (std::size_t p = 0; p + 1 < starts.size(); ++p) {
    std::int64_t total = starts[p];
    for (auto& counts : offsets) {
      const std::int64_t count = counts[p];
      counts[p] = total;
      total += count;
    }
    starts[p + 1] = total;
  }
  // All passes share one buffer, as large as the largest of them.
  std::vector<std::int64_t> pass_ends;
  std::int64_t largest = 0;
  for (std::int64_t begin = 0; begin < plan.num_partitions;) {
    std::int64_t end = begin + 1;
    const std::int64_t start = starts[static_cast<std::size_t>(begin)];
    while (end < plan.num_partitions && starts[static_cast<std::size_t>(end) + 1] - start <= plan.max_entries_at_once) ++end;
    pass_ends.push_back(end);
    largest = std::max(largest, starts[static_cast<std::size_t>(end)] - start);
    begin = end;
  }
  const auto buffer = std::make_unique_for_overwrite<Entry[]>(static_cast<std::size_t>(largest));
  std::int64_t begin = 0;
  for (const std::int64_t end : pass_ends) {
    const std::int64_t base = starts[static_cast<std::size_t>(begin)];
    for_each_task(plan.num_threads, num_slices, [&](int, std::int64_t slice) {
      std::int64_t* const next = offsets[static_cast<std::size_t>(slice)].data();
      Entry* const out = buffer.get();
      scan(slice_start(slice), slice_start(slice + 1), [&, next, out](std::int64_t partition, const Entry& entry) {
        if (partition >= begin && partition < end) out[next[partition]++ - base] = entry;
      });
    });
    for_each_task(plan.num_threads, end - begin, [&](int worker, std::int64_t i) {
      const auto p = static_cast<std::size_t>(begin + i);
      consume(worker, begin + i,
              std::span<Entry>(buffer.get() + (starts[p] - base), static_cast<std::size_t>(starts[p + 1] - starts[p])));
    });
    begin = end;
  }
}

}  // namespace pcbmesh::validation::checks
