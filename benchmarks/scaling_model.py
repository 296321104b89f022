"""Ranks that share tiles, event by event, by the rules of src/parallel/schedule.c, dispatch.c and local_records.c."""

import heapq
import math
from dataclasses import dataclass, field

BATCH_SECONDS, SECONDS_A_RANK = 0.1, 1e-4  # of src/parallel/schedule.c
ROUNDING = 1e-9  # of the sum of rates
WAIT = -1


@dataclass(frozen=True)
class Costs:
    """Seconds of a message one way, as benchmarks/messages.c measures it over TCP; until rank 0 looks for it, at most;
    and rank 0's for an answer. All 0: ranks that know of each other without messages."""
    message: float = 6e-4
    look: float = 1e-3
    answer: float = 6e-6


class Schedule:
    """Who gets how many tiles."""

    def __init__(self, tiles, ranks):
        self.next, self.end, self.ranks, self.taking, self.rate = min(ranks, tiles), tiles, ranks, ranks, 0.0
        self.seconds = [0.0] * ranks

    def note(self, rank, seconds):
        if seconds > 0:
            self.rate += 1 / seconds - (1 / self.seconds[rank] if self.seconds[rank] else 0)
            self.seconds[rank] = seconds

    def retire(self, rank):
        seconds = self.seconds[rank]
        others = self.rate - 1 / seconds if seconds > 0 else 0
        if seconds * others <= max(ROUNDING, self.end - self.next + self.taking - 1):
            return False
        self.rate, self.seconds[rank], self.taking = others, 0.0, self.taking - 1
        return True

    def take(self, rank):
        """The next tile, or None."""
        if self.next == self.end or self.retire(rank):
            return None
        self.next += 1
        return self.next - 1

    def grant(self, rank, early):
        """First tile and number of tiles."""
        left, seconds, tiles = self.end - self.next, self.seconds[rank], 1.0
        if not left or (not early and self.retire(rank)):
            return self.next, 0
        if seconds > 0:
            rest = left / max(self.rate, 1 / seconds)
            if early and rest < 2 * seconds:
                return self.next, 0
            tiles = min(rest / 2, max(BATCH_SECONDS, SECONDS_A_RANK * self.ranks)) / seconds
        first, n = self.next, min(left, max(1, int(tiles)))
        self.next += n
        return first, n


@dataclass
class Rank:
    """What a rank has in hand, and what it has done."""
    number: int
    first: int
    n: int
    more: bool = True
    answer: tuple | None = None  # time, first, n, more
    busy: float = 0.0
    tiles: list = field(default_factory=list)

    def seconds_a_tile(self):
        return self.busy / len(self.tiles) if self.tiles else 0


class Stage:
    """Tiles that are drawn: src/parallel/dispatch.c."""

    def __init__(self, seconds, ranks, costs, slower=1.0):
        self.seconds, self.costs, self.slower, self.desk = seconds, costs, slower, 0.0
        self.schedule = Schedule(len(seconds), ranks)
        self.workers = [Rank(i, i, int(i < len(seconds))) for i in range(ranks)]
        self.end = self._run()

    def idle(self):
        """The share of their time in which ranks had nothing to do."""
        return 1 - sum(rank.busy for rank in self.workers) / (self.end * len(self.workers)) if self.end > 0 else 0.0

    def _ask(self, rank, time, early):
        self.desk = max(self.desk, time + self.costs.message + self.costs.look) + self.costs.answer
        self.schedule.note(rank.number, rank.seconds_a_tile())
        first, n = self.schedule.grant(rank.number, early)
        more = self.schedule.next < self.schedule.end and (n > 0 or early)
        rank.answer = self.desk + self.costs.message, first, n, more

    def _take(self, rank, time):
        """The next tile (None: no more); WAIT until the time returned where the answer is not there yet."""
        if rank.number == 0:
            self.schedule.note(0, rank.seconds_a_tile())
            tile, rank.n = (rank.first if rank.n else self.schedule.take(0)), 0
            return time, tile
        while not rank.n and rank.more:
            if not rank.answer:
                self._ask(rank, time, False)
            if rank.answer[0] > time:
                return rank.answer[0], WAIT
            (_, rank.first, rank.n, rank.more), rank.answer = rank.answer, None
        if not rank.n:
            return time, None
        rank.first, rank.n = rank.first + 1, rank.n - 1
        if not rank.n and rank.more and rank.tiles:
            self._ask(rank, time, True)
        return time, rank.first - 1

    def _run(self):
        queue, end = [(0.0, rank.number) for rank in self.workers], 0.0
        while queue:
            time, number = heapq.heappop(queue)
            rank = self.workers[number]
            begins, tile = self._take(rank, time)
            end = max(end, begins)
            if tile == WAIT:
                heapq.heappush(queue, (begins, number))
            elif tile is not None:
                spent = self.seconds[tile] * (self.slower if number == len(self.workers) - 1 > 0 else 1)
                rank.busy += spent
                rank.tiles.append(tile)
                heapq.heappush(queue, (begins + spent, number))
        return end


def delivered(workers, make, take):
    """Seconds of the stage `file`: each rank packs what it labelled, rank 0 writes everybody's messages between its
    own."""
    packing = [sum(make[tile] for tile in rank.tiles) for rank in workers]
    return max(max(packing), packing[0] + take * len(make))


def collective(ranks, costs):
    """Seconds of a collective call, there and back in a tree."""
    return 2 * math.ceil(math.log2(ranks)) * costs.message


def resampled(seconds, n):
    """Seconds of n tiles of the same total, spread as those of the given ones."""
    total, edges = [0.0], [i * len(seconds) / n for i in range(n + 1)]
    for s in seconds:
        total.append(total[-1] + s)

    def until(x):
        i = min(int(x), len(seconds) - 1)
        return total[i] + (x - i) * seconds[i]

    return [until(b) - until(a) for a, b in zip(edges, edges[1:], strict=False)]
