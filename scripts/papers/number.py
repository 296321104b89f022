"""One number of a paper: what is printed, what other methods give, what the program gives, and the agreement."""

from dataclasses import dataclass
from decimal import Decimal

FAILED = "FAILED"


@dataclass
class Number:
    """`printed`: as the paper writes it; `reference`: by other methods, known to `bar`; `remark`: why ours is not what
    is printed."""

    place: str
    quantity: str
    ours: float
    printed: str = ""
    reference: float | None = None
    bar: float = 0.0
    remark: str = ""
    kind: str = "erratum"  # of the remark: erratum, or approximation (what is printed is meant as one)
    printed_bar: float | None = None  # where the paper says "about"

    def __post_init__(self) -> None:
        self.ours = float(self.ours)
        if self.reference is not None:
            self.reference = float(self.reference)

    @property
    def as_printed(self) -> bool:
        """Whether ours rounds to what is printed: half a unit of its last digit."""
        unit = float(Decimal(1).scaleb(int(Decimal(self.printed).as_tuple().exponent)))
        bar = unit / 2 if self.printed_bar is None else self.printed_bar
        return abs(self.ours - float(self.printed)) <= bar * (1 + 1e-9)

    @property
    def agreement(self) -> str:
        """right, erratum, approximation or FAILED; a remark that explains nothing is a failure too."""
        if self.reference is not None and not abs(self.ours - self.reference) <= self.bar:
            return FAILED
        if not self.printed:
            return "right"
        if self.as_printed:
            return FAILED if self.remark else "right"
        return self.kind if self.remark else FAILED
