"""Laws: one cited equation, one function; SI in and out, no units, no models."""
