"""How well a few typed letters fit a text."""

WORD_STARTS = " ./_-"


def fitness(query: str, text: str) -> float:
    """Larger is better; 0 when some word of *query* is not found in *text*.

    Every word of the query must be there, its letters in order; whole words and beginnings of words count most.
    """
    words = query.lower().split()
    scores = [_word_fitness(word, text.lower()) for word in words]
    return sum(scores) / len(scores) if words and all(scores) else float(not words)


def _word_fitness(word: str, text: str) -> float:
    place = text.find(word)
    while place > 0 and text[place - 1] not in WORD_STARTS and (later := text.find(word, place + 1)) > 0:
        place = later
    if place >= 0:
        starts_word = place == 0 or text[place - 1] in WORD_STARTS
        return (3.0 if starts_word else 2.0) + len(word) / (len(text) + 1) - place / 1000
    return _scattered_fitness(word, text)


def _scattered_fitness(word: str, text: str) -> float:
    """Below 1: the letters are there in order, the fewer gaps the better."""
    place, gaps = -1, 0
    for letter in word:
        found = text.find(letter, place + 1)
        if found < 0:
            return 0.0
        gaps += found > place + 1 and place >= 0 and text[found - 1] not in WORD_STARTS
        place = found
    return 0.9 / (1 + gaps) if gaps <= 2 else 0.0
