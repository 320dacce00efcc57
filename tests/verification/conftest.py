"""The whole registry, computed once."""

import pytest

from rollnip.verification import all_cases, verify


@pytest.fixture(scope="session")
def outcomes():
    """VerificationResult of every case, by problem and quantity."""
    return {(o.case.name, o.case.quantity): o for o in verify(all_cases())}
