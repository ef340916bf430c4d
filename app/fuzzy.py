"""How well a few typed letters fit a text."""

WORD_STARTS = " ./_-"
BESIDE = 0.45  # what a word found beside the text counts for


def fitness(query: str, text: str, beside: str = "") -> float:
    """Larger is better; 0 when some word of *query* is found neither in *text* nor, in one piece, in *beside*.

    Whole words and beginnings of words count most; the letters may be scattered over *text* only from the beginning
    of a word on.
    """
    text, beside = text.lower(), beside.lower()
    scores = [
        max(_word_fitness(word, text) or _scattered_fitness(word, text), BESIDE * _word_fitness(word, beside))
        for word in query.lower().split()
    ]
    return sum(scores) / len(scores) if scores and all(scores) else float(not scores)


def _word_fitness(word: str, text: str) -> float:
    """4 for a whole word, 3 for the beginning of one, 2 for the middle; a little more in short texts and early."""
    best = 0.0
    place = text.find(word)
    while place >= 0:
        end = place + len(word)
        starts = place == 0 or text[place - 1] in WORD_STARTS
        ends = end == len(text) or text[end] in WORD_STARTS
        best = max(best, 2.0 + starts + (starts and ends) + len(word) / (len(text) + 1) - place / 1000)
        place = text.find(word, place + 1)
    return best


def _scattered_fitness(word: str, text: str) -> float:
    """Below 1: the letters are there in order, the fewer gaps the better."""
    place, gaps = -1, 0
    for letter in word:
        found = text.find(letter, place + 1)
        while place < 0 < found and text[found - 1] not in WORD_STARTS:
            found = text.find(letter, found + 1)
        if found < 0:
            return 0.0
        gaps += found > place + 1 and place >= 0 and text[found - 1] not in WORD_STARTS
        place = found
    return 0.9 / (1 + gaps) if gaps <= 2 else 0.0
