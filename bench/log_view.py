"""The responsiveness of the log view under a flood: `python -m bench.log_view [SECONDS]`.

A headless app of 120x40 cells gets 10 000 lines/s in 20 batches per second, folded and unfolded,
following and paused, in English and in Russian. The results are the longest time that the event
loop was blocked, the CPU share of one core, and the cost of a line.
"""

from __future__ import annotations

import asyncio
import resource
import sys
import time

from textual.app import App, ComposeResult

from launcher.status import LogLine, Severity
from tui.log_view.filter import LogFilter
from tui.log_view.pane import LogPane
from tui.log_view.view import LogView

LINES_PER_S = 10_000
BATCHES_PER_S = 20
TEXTS = {
    "English": "Distance published: 1.84 m to the nearest obstacle, way is free, go on",
    "Cyrillic": "Публикую дистанцию: 1.84 м до ближайшего препятствия, путь свободен, едем",
    "emoji": "🧠 Услышал голос: Look around and tell me what you see! 🎙️ Думаю над ответом и еду",
}


class FloodApp(App[None]):
    """An app with nothing but the log."""

    def compose(self) -> ComposeResult:
        """The log fills the screen."""
        yield LogPane(LogView())


async def longest_gap(stop: asyncio.Event) -> float:
    """Return the longest time in s that the loop was blocked, beyond the requested millisecond."""
    longest = 0.0
    while not stop.is_set():
        before = time.perf_counter()
        await asyncio.sleep(0.001)
        longest = max(longest, time.perf_counter() - before - 0.001)
    return longest


async def flood(view: LogView, text: str, seconds: float) -> int:
    """Append lines until the time is over; return how many."""
    size = LINES_PER_S // BATCHES_PER_S
    start, seq = time.perf_counter(), 0
    for batch in range(int(seconds * BATCHES_PER_S)):
        now = time.time()
        lines = [LogLine("noisy", seq + n, now, Severity.INFO, f"{text} {seq + n}") for n in range(size)]
        lines.append(LogLine("quiet", batch + 1, now, Severity.WARN, "still here"))
        seq += size
        view.append(lines)
        await asyncio.sleep(max(0.0, start + (batch + 1) / BATCHES_PER_S - time.perf_counter()))
    return seq


async def measure(name: str, seconds: float, *, fold: bool, follow: bool, search: str = "") -> None:
    """Run one flood and print its figures."""
    app = FloodApp()
    async with app.run_test(size=(120, 40)) as pilot:
        view = app.query_one(LogView)
        view.set_fold(fold)
        view.append([LogLine("quiet", 0, time.time(), Severity.INFO, "first")] * 100)
        view.log_filter = LogFilter(search=search)
        await pilot.pause()
        if not follow:
            view.pause()
        stop = asyncio.Event()
        watcher = asyncio.create_task(longest_gap(stop))
        cpu, start = time.process_time(), time.perf_counter()
        count = await flood(view, TEXTS[name], seconds)
        cpu, wall = time.process_time() - cpu, time.perf_counter() - start
        stop.set()
        gap = await watcher
        kept = sum(entry.node == "quiet" for entry in view.ring.entries)
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        how = (
            name,
            "folded" if fold else "unfolded",
            "following" if follow else "paused",
            "searching" if search else "",
        )
        print(
            f"{' '.join(how):38} {count / wall:7.0f} lines/s  "
            f"longest gap {gap * 1000:5.0f} ms  CPU {100 * cpu / wall:4.0f} %  "
            f"{1e6 * cpu / count:4.1f} us/line  quiet kept {kept}  peak {memory:4.0f} MB"
        )


async def main(seconds: float) -> None:
    """Run all kinds of floods."""
    for name in TEXTS:
        await measure(name, seconds, fold=True, follow=True)
    await measure("Cyrillic", seconds, fold=False, follow=True)
    await measure("Cyrillic", seconds, fold=True, follow=False)
    await measure("Cyrillic", seconds, fold=True, follow=True, search="дистанцию")


if __name__ == "__main__":
    asyncio.run(main(float(sys.argv[1]) if len(sys.argv) > 1 else 5.0))
