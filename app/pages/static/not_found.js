// Say which address holds nothing.
document.getElementById("address").textContent = location.pathname;
