"""From files of a laboratory to a compound, the page that is signed, and the input of other programs."""
